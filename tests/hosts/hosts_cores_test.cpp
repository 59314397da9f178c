// SPDX-License-Identifier: Apache-2.0
// The reason for several machines: the tracker has its machine's processor for itself.
#include <gtest/gtest.h>

#include "tests/hosts/hosts_check.hpp"

namespace rds::test {
namespace {

class HostsCores : public testing::TestWithParam<bus::Vendor> {};
TEST_P(HostsCores, LeaveTheTrackerItsOwn) {
  expect_split_cores(core_rows(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Each, HostsCores, testing::Values(bus::Vendor::kFastDds, bus::Vendor::kCycloneDds),
                         [](const auto& vendor) { return bus::name_of(vendor.param); });

}  // namespace
}  // namespace rds::test
