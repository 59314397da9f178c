// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/image/tum_dataset.hpp"
#include "tests/support/shared_data.hpp"
#include "tools/rds/doctor/checks/dataset_check.hpp"

namespace rds::doctor {
namespace {
using testing::HasSubstr;

std::vector<Finding> check(const std::string& recording) {
  const auto dataset = image::TumDataset::open(test::shared() / "data" / recording);
  if (!dataset) throw std::runtime_error(dataset.error());
  return check_dataset(*dataset, 10);
}

Finding about(const std::string& subject, const std::vector<Finding>& findings) {
  const auto found = std::ranges::find(findings, subject, &Finding::subject);
  return found == findings.end() ? Finding{Verdict::kFault, "", "not checked"} : *found;
}

TEST(DatasetCheckRecorded, FindsThatTheKitchensDepthIsNotRegistered) {
  RDS_REQUIRE_SHARED("data/7scenes_kitchen");
  const auto findings = check("7scenes_kitchen");
  EXPECT_FALSE(any_fault(findings)) << to_text(findings);
  EXPECT_EQ(about("registration", findings).verdict, Verdict::kHint);
  EXPECT_THAT(about("registration", findings).sentence, HasSubstr("scaled by 0.90 about the centre"));
}

TEST(DatasetCheckRecorded, FindsNoFaultInFreiburg1) {
  RDS_REQUIRE_SHARED("data/tum_fr1_rpy");
  const auto findings = check("tum_fr1_rpy");
  EXPECT_FALSE(any_fault(findings)) << to_text(findings);
  EXPECT_EQ(about("registration", findings).verdict, Verdict::kGood);
  EXPECT_EQ(about("depth scale", findings).verdict, Verdict::kGood);
  EXPECT_THAT(about("frames", findings).sentence, HasSubstr("without depth within 20 ms: 2,"));
}

}  // namespace
}  // namespace rds::doctor
