// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/input/picture_registration.hpp"

#include <gmock/gmock.h>

namespace rds::tracker {
namespace {

using ::testing::HasSubstr;

geometry::Lens lens(int width, int height, geometry::LensModel model = geometry::LensModel::kPlumbBob) {
  return {.width = width,
          .height = height,
          .fx = 0.8 * width,
          .fy = 0.8 * width,
          .cx = width / 2.0 - 0.5,
          .cy = height / 2.0 - 0.5,
          .model = model};
}
image::ColorImage color(int width, int height) {
  return {cv::Mat3b(height, width, cv::Vec3b(1, 2, 3)), image::ChannelOrder::kBgr, nullptr};
}
image::DepthImage depth(int width, int height) {
  return {cv::Mat1w(height, width, std::uint16_t{1500}), 0.001F, nullptr};
}

TEST(PictureRegistration, LeavesPicturesOfAPlainLensAsTheyAre) {
  PictureRegistration registration;
  EXPECT_FALSE(registration.camera());
  registration.set_color_lens(lens(64, 48));
  const auto before = color(64, 48);
  EXPECT_EQ(registration.color(before, "c")->pixels.data, before.pixels.data);
  const auto registered = depth(64, 48);
  EXPECT_EQ(registration.depth(registered, "c")->values.data, registered.values.data);
  EXPECT_EQ(registration.camera()->width, 64);
}

TEST(PictureRegistration, UndistortsColourAndItsDepth) {
  PictureRegistration registration;
  registration.set_color_lens(lens(64, 48, geometry::LensModel::kEquidistant));
  const auto before = color(64, 48);
  EXPECT_NE(registration.color(before, "c")->pixels.data, before.pixels.data);
  EXPECT_FLOAT_EQ(registration.depth(depth(64, 48), "c")->at(32, 24), 1.5F);
  EXPECT_FALSE(registration.camera()->has_distortion());
}

TEST(PictureRegistration, RegistersDepthOfAnotherSizeInTheSameFrame) {
  PictureRegistration registration;
  registration.set_color_lens(lens(64, 48));
  registration.set_depth_lens(lens(32, 24));
  ASSERT_TRUE(registration.color(color(64, 48), "c"));
  const auto registered = registration.depth(depth(32, 24), "c");
  ASSERT_TRUE(registered) << registered.error();
  EXPECT_EQ(registered->values.size(), cv::Size(64, 48));
  EXPECT_FLOAT_EQ(registered->at(10, 10), 1.5F);
}

TEST(PictureRegistration, SaysWhatDepthOfAnotherSizeLacks) {
  PictureRegistration registration;
  registration.set_color_lens(lens(64, 48));
  ASSERT_TRUE(registration.color(color(64, 48), "c"));
  EXPECT_THAT(registration.depth(depth(32, 24), "c").error(),
              AllOf(HasSubstr("depth of 32×24 px, colour of 64×48"), HasSubstr("camera_info"),
                    HasSubstr("align_depth")));
  registration.set_depth_lens(lens(32, 24));
  EXPECT_THAT(registration.depth(depth(32, 24), "d").error(), HasSubstr("in frame 'd', not 'c'"));
  EXPECT_THAT(registration.depth(depth(16, 12), "c").error(), HasSubstr("depth's camera_info is of 32×24"));
}

TEST(PictureRegistration, RefusesPicturesThatAreNotOfTheirCameraInfo) {
  PictureRegistration registration;
  registration.set_color_lens(lens(64, 48));
  EXPECT_THAT(registration.color(color(32, 24), "c").error(),
              HasSubstr("pictures of 32×24 px, but camera_info is of 64×48"));
}

}  // namespace
}  // namespace rds::tracker
