// SPDX-License-Identifier: Apache-2.0
// The rows that tell most of the table of links between machines, each compared with one machine.
#include <gtest/gtest.h>

#include "tests/hosts/hosts_check.hpp"

namespace rds::test {
namespace {

std::string name_of(const testing::TestParamInfo<Row>& row) {
  return row.param.label();
}

class HostsOnOneMachine : public testing::TestWithParam<Row> {};
TEST_P(HostsOnOneMachine, IsWhatOthersAreComparedWith) {
  expect_baseline(GetParam());
}

class Hosts : public testing::TestWithParam<Row> {};
TEST_P(Hosts, AreAsGoodAsOneMachine) {
  expect_row(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Before, HostsOnOneMachine, testing::ValuesIn(one_machine_rows()), name_of);
INSTANTIATE_TEST_SUITE_P(Each, Hosts, testing::ValuesIn(short_rows()), name_of);

}  // namespace
}  // namespace rds::test
