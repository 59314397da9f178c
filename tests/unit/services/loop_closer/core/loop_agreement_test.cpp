// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/loop_agreement.hpp"

#include <gmock/gmock.h>

namespace rds::loop_closer {
namespace {

LoopDetection asking_for(std::size_t candidate, double shift_m) {
  LoopDetection detection;
  detection.query = 30;
  detection.candidate = candidate;
  detection.correction.translation().x() = shift_m;
  return detection;
}

std::vector<std::size_t> candidates(const std::vector<LoopDetection>& detections) {
  std::vector<std::size_t> all;
  for (const LoopDetection& d : detections) all.push_back(d.candidate);
  return all;
}

TEST(LoopAgreement, TakesThoseThatAskForOneCorrection) {
  const std::vector detections{asking_for(3, -0.50), asking_for(9, 0.30), asking_for(15, 0.32),
                               asking_for(21, 0.90)};
  EXPECT_THAT(candidates(most_that_agree(detections)), testing::ElementsAre(9, 15));
}

TEST(LoopAgreement, TakesTheFirstWhereAllDisagree) {
  const std::vector detections{asking_for(3, 0.3), asking_for(9, -0.5), asking_for(15, 0.9)};
  EXPECT_THAT(candidates(most_that_agree(detections)), testing::ElementsAre(3));
}

TEST(LoopAgreement, TakesNothingOfNothing) {
  EXPECT_TRUE(most_that_agree({}).empty());
}

TEST(LoopAgreement, ComparesTurnsToo) {
  LoopDetection turned = asking_for(9, 0);
  turned.correction.linear() = Eigen::AngleAxisd(0.06, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_FALSE(is_consistent(asking_for(3, 0), turned));
}

}  // namespace
}  // namespace rds::loop_closer
