// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/host_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/common/bus/bus_test_support.hpp"

namespace rds::doctor {
namespace {

TEST(HostCheck, AcceptsDomainsThatDdsHasPortsFor) {
  EXPECT_EQ(check_domain(nullptr).verdict, Verdict::kGood);
  EXPECT_EQ(check_domain("0").verdict, Verdict::kGood);
  EXPECT_EQ(check_domain("232").verdict, Verdict::kGood);
  for (const char* bad : {"", "233", "-1", "1.5", "seven", "1e99"})
    EXPECT_EQ(check_domain(bad).verdict, Verdict::kFault) << bad;
}

TEST(HostCheck, DescribesThisMachine) {
  EXPECT_THAT(check_processor().sentence, testing::HasSubstr("cores"));
  EXPECT_THAT(check_memory().sentence, testing::HasSubstr("GiB free"));
  EXPECT_EQ(check_disk("/").subject, "disk");
  EXPECT_EQ(check_disk("/no/such/folder").verdict, Verdict::kFault);
  EXPECT_THAT(check_receive_buffer().sentence, testing::HasSubstr("bytes"));
}

TEST(HostCheck, AllVendorsJoin) {
  for (const bus::Vendor vendor : bus::kAllVendors)
    EXPECT_EQ(check_vendor(vendor).verdict, Verdict::kGood) << bus::name_of(vendor);
}

}  // namespace
}  // namespace rds::doctor
