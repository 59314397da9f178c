// SPDX-License-Identifier: Apache-2.0
// The reason for several machines: the tracker has its machine's processor for itself.
#include <gtest/gtest.h>

#include "tests/hosts/hosts_check.hpp"
#include "tests/support/bus/vendors.hpp"

namespace rds::test {
namespace {

class HostsCores : public testing::TestWithParam<bus::Vendor> {};
TEST_P(HostsCores, LeaveTheTrackerItsOwn) {
  expect_split_cores(core_rows(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Each, HostsCores, testing::ValuesIn(kAllVendors), vendor_name);

}  // namespace
}  // namespace rds::test
