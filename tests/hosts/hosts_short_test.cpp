// SPDX-License-Identifier: Apache-2.0
// The rows that tell most of the table of links between machines: all arrives. For machines that do other work,
// too: what depends on time is looked at in the whole table.
#include <gtest/gtest.h>

#include "tests/hosts/hosts_check.hpp"

namespace rds::test {
namespace {

class HostsShort : public testing::TestWithParam<Row> {};
TEST_P(HostsShort, LoseNothing) {
  expect_complete(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Each, HostsShort, testing::ValuesIn(short_rows()),
                         [](const auto& row) { return row.param.label(); });

}  // namespace
}  // namespace rds::test
