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
const cv::Size kSize(64, 48);
const cv::Size kHalf(32, 24);

TEST(PictureRegistration, LeavesPicturesOfAPlainLensAsTheyAre) {
  PictureRegistration registration;
  registration.set_color_lens(lens(64, 48));
  EXPECT_EQ(registration.color(kSize, "c").value(), nullptr);
  EXPECT_EQ(registration.depth(kSize, "c").value(), nullptr);
}

TEST(PictureRegistration, UndistortsColourAndItsDepthByOneTable) {
  PictureRegistration registration;
  registration.set_color_lens(lens(64, 48, geometry::LensModel::kEquidistant));
  const auto table = registration.color(kSize, "c").value();
  ASSERT_NE(table, nullptr);
  EXPECT_FALSE(table->target().has_distortion());
  EXPECT_EQ(registration.depth(kSize, "c").value(), table);
}

TEST(PictureRegistration, RegistersDepthOfAnotherSizeInTheSameFrame) {
  PictureRegistration registration;
  registration.set_color_lens(lens(64, 48));
  registration.set_depth_lens(lens(32, 24));
  ASSERT_TRUE(registration.color(kSize, "c"));
  const auto table = registration.depth(kHalf, "c").value();
  ASSERT_NE(table, nullptr);
  const auto registered = table->depth({cv::Mat1w(kHalf, std::uint16_t{1500}), 0.001F, nullptr});
  EXPECT_EQ(registered.values.size(), kSize);
  EXPECT_FLOAT_EQ(registered.at(10, 10), 1.5F);
}

TEST(PictureRegistration, SaysWhatDepthOfAnotherSizeLacks) {
  PictureRegistration registration;
  registration.set_color_lens(lens(64, 48));
  ASSERT_TRUE(registration.color(kSize, "c"));
  EXPECT_THAT(registration.depth(kHalf, "c").error(),
              AllOf(HasSubstr("depth of 32×24 px, colour of 64×48"), HasSubstr("camera_info"),
                    HasSubstr("align_depth")));
  registration.set_depth_lens(lens(32, 24));
  EXPECT_THAT(registration.depth(kHalf, "d").error(), HasSubstr("in frame 'd', not 'c'"));
  EXPECT_THAT(registration.depth({16, 12}, "c").error(), HasSubstr("depth's camera_info is of 32×24"));
}

TEST(PictureRegistration, RefusesPicturesThatAreNotOfTheirCameraInfo) {
  PictureRegistration registration;
  registration.set_color_lens(lens(64, 48));
  EXPECT_THAT(registration.color(kHalf, "c").error(),
              HasSubstr("pictures of 32×24 px, but camera_info is of 64×48"));
}

}  // namespace
}  // namespace rds::tracker
