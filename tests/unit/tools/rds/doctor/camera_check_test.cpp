// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/camera_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rds::doctor {
namespace {
using testing::HasSubstr;

const geometry::CameraModel kCamera{640, 480, 525, 525, 319.5, 239.5, {}};

TEST(CameraCheck, AcceptsAUsualCamera) {
  EXPECT_EQ(check_camera(kCamera).verdict, Verdict::kGood);
  EXPECT_THAT(check_camera(kCamera).sentence, HasSubstr("640×480 px, field of view 63°"));
}

TEST(CameraCheck, FindsIntrinsicsOfAnotherPictureSize) {
  auto camera = kCamera;
  camera.fx = camera.fy = 2100;
  EXPECT_THAT(check_camera(camera).sentence, HasSubstr("fx 2100 px is hardly this camera's"));
  camera.cx = 639.5;
  EXPECT_THAT(check_camera(camera).sentence,
              HasSubstr("principal point (639.5, 239.5) is far from the middle"));
  EXPECT_EQ(check_camera(camera).verdict, Verdict::kHint);
}

TEST(CameraCheck, FindsPixelsThatAreNotSquare) {
  auto camera = kCamera;
  camera.fy = 394;
  EXPECT_THAT(check_camera(camera).sentence, HasSubstr("square"));
}

}  // namespace
}  // namespace rds::doctor
