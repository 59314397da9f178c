// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/finding.hpp"

#include <gtest/gtest.h>

namespace rds::doctor {
namespace {

TEST(Findings, AreLinesAndOnlyFaultsCount) {
  const std::vector<Finding> findings{{Verdict::kGood, "disk", "12 GiB"}, {Verdict::kHint, "memory", "low"}};
  EXPECT_EQ(to_text(findings), "ok     disk               12 GiB\nhint   memory             low\n");
  EXPECT_FALSE(any_fault(findings));
  EXPECT_TRUE(any_fault({{Verdict::kFault, "x", "y"}}));
}

}  // namespace
}  // namespace rds::doctor
