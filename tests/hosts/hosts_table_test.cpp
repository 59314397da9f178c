// SPDX-License-Identifier: Apache-2.0
// All rows of the table of links between machines, each compared with one machine.
#include <gtest/gtest.h>

#include "tests/hosts/hosts_check.hpp"

namespace rds::test {
namespace {

std::string name_of(const testing::TestParamInfo<Row>& row) {
  return row.param.label();
}

class HostsTableOnOneMachine : public testing::TestWithParam<Row> {};
TEST_P(HostsTableOnOneMachine, IsWhatOthersAreComparedWith) {
  expect_baseline(GetParam());
}

class HostsTable : public testing::TestWithParam<Row> {};
TEST_P(HostsTable, AreAsGoodAsOneMachine) {
  expect_row(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Before, HostsTableOnOneMachine, testing::ValuesIn(one_machine_rows()), name_of);
INSTANTIATE_TEST_SUITE_P(Each, HostsTable, testing::ValuesIn(all_rows()), name_of);

}  // namespace
}  // namespace rds::test
