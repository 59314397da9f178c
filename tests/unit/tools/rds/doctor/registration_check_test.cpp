// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/registration_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rds::doctor {
namespace {
using testing::HasSubstr;
using testing::Not;

const geometry::CameraModel kCamera{640, 480, 585, 585, 320, 240, {}};
const RegistrationFit kUnregistered{{0.9, {-7, -2}}, 0.63, 0.42, 0.34, 1, 45};

TEST(RegistrationCheck, SaysWhereDepthFitsAndTheFocalLengthThatFollows) {
  const auto finding = check_registration(kUnregistered, kCamera);
  EXPECT_EQ(finding.verdict, Verdict::kHint);
  EXPECT_THAT(finding.sentence, HasSubstr("scaled by 0.90 about the centre and moved by (-7, -2) px"));
  EXPECT_THAT(finding.sentence, HasSubstr("near 525 px"));
}

TEST(RegistrationCheck, SaysNothingOfAFocalLengthAboutAMereShift) {
  auto fit = kUnregistered;
  fit.best.scale = 1.005;
  EXPECT_EQ(check_registration(fit, kCamera).verdict, Verdict::kHint);
  EXPECT_THAT(check_registration(fit, kCamera).sentence, Not(HasSubstr("585")));
}

TEST(RegistrationCheck, NeedsAClearlyBetterFit) {
  for (auto change :
       {+[](RegistrationFit& f) { f.agreement_as_is = 0.6; },
        +[](RegistrationFit& f) { f.agreement_beside = 0.6; },
        +[](RegistrationFit& f) { f.frames_better = 0.7; }, +[](RegistrationFit& f) { f.farthest_px = 5; }}) {
    auto fit = kUnregistered;
    change(fit);
    EXPECT_EQ(check_registration(fit, kCamera).verdict, Verdict::kGood);
  }
}

TEST(RegistrationCheck, DoesNotGuess) {
  EXPECT_EQ(check_registration(std::nullopt, kCamera).verdict, Verdict::kGood);
  EXPECT_THAT(check_registration(std::nullopt, kCamera).sentence, HasSubstr("cannot be told"));
}

}  // namespace
}  // namespace rds::doctor
