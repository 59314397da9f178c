// SPDX-License-Identifier: Apache-2.0
#include "common/image/registration/picture_registration.hpp"

#include <tuple>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace rds::image {
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

/// tf of a camera whose depth camera "d" is 5 cm beside colour's "c"; "alias" is where "c" is.
std::optional<geometry::Pose> tf(const std::string& target, const std::string& source, std::int64_t) {
  const auto x = [](const std::string& frame) { return frame == "d" ? -0.05 : 0; };
  if (target == "lost" || source == "lost") return std::nullopt;
  return geometry::make_pose({x(source) - x(target), 0, 0}, Eigen::Quaterniond::Identity());
}

/// With colour's lens, and depth's of half the size.
PictureRegistration registration_of(geometry::LensModel model = geometry::LensModel::kPlumbBob) {
  PictureRegistration registration(tf);
  registration.set_color_lens(lens(64, 48, model), "c");
  registration.set_depth_lens(lens(32, 24));
  return registration;
}

const cv::Size kSize(64, 48);
const cv::Size kHalf(32, 24);

DepthImage flat(const cv::Size& size) {
  return {cv::Mat1w(size, std::uint16_t{1500}), 0.001F, nullptr};
}

TEST(PictureRegistration, LeavesPicturesOfAPlainLensAsTheyAre) {
  PictureRegistration registration = registration_of();
  EXPECT_FALSE(registration.color(kSize, "c").value());
  EXPECT_FALSE(registration.depth(kSize, "c", 0).value());
  EXPECT_FALSE(registration.depth(kSize, "alias", 0).value()) << "in the same place, under another name";
  EXPECT_FALSE(registration.depth(kSize, "", 0).value());
}

TEST(PictureRegistration, UndistortsColourAndItsDepth) {
  PictureRegistration registration = registration_of(geometry::LensModel::kEquidistant);
  const auto color = registration.color(kSize, "c").value();
  ASSERT_TRUE(color);
  EXPECT_EQ(color({cv::Mat3b(kSize), ChannelOrder::kRgb, nullptr}).pixels.size(), kSize);
  const auto depth = registration.depth(kSize, "c", 0).value();
  ASSERT_TRUE(depth);
  EXPECT_FLOAT_EQ(depth(flat(kSize)).at(32, 24), 1.5F);
}

TEST(PictureRegistration, RegistersDepthOfAnotherSizeInTheSameFrame) {
  PictureRegistration registration = registration_of();
  ASSERT_TRUE(registration.color(kSize, "c"));
  const auto depth = registration.depth(kHalf, "c", 0).value();
  ASSERT_TRUE(depth);
  const auto registered = depth(flat(kHalf));
  EXPECT_EQ(registered.values.size(), kSize);
  EXPECT_FLOAT_EQ(registered.at(10, 10), 1.5F);
}

TEST(PictureRegistration, MovesDepthOfACameraElsewhere) {
  PictureRegistration registration = registration_of();
  const auto depth = registration.depth(kHalf, "d", 0).value();
  ASSERT_TRUE(depth);
  DepthImage half_seen = flat(kHalf);
  half_seen.values.colRange(16, 32) = 0;  // from the middle on
  const auto registered = depth(half_seen);
  ASSERT_EQ(registered.values.size(), kSize);
  const int edge = 32 - static_cast<int>(0.05 / 1.5 * 51.2);  // moved by 1.7 px of colour's
  EXPECT_FLOAT_EQ(registered.at(edge - 2, 20), 1.5F);
  EXPECT_EQ(registered.at(edge + 1, 20), 0);
}

TEST(PictureRegistration, MovesDepthOfColoursSizeToo) {
  PictureRegistration registration = registration_of();
  registration.set_depth_lens(lens(64, 48));
  const auto depth = registration.depth(kSize, "d", 0).value();
  ASSERT_TRUE(depth);
  EXPECT_FLOAT_EQ(depth(flat(kSize)).at(32, 24), 1.5F);
  EXPECT_EQ(depth(flat(kSize)).at(63, 24), 0) << "nothing is seen there from the left";
}

TEST(PictureRegistration, SaysWhatDepthOfAnotherSizeOrFrameLacks) {
  PictureRegistration registration(tf);
  registration.set_color_lens(lens(64, 48), "c");
  ASSERT_TRUE(registration.color(kSize, "c"));
  for (const char* frame : {"c", "d"})
    EXPECT_THAT(
        registration.depth(kHalf, frame, 0).error(),
        AllOf(HasSubstr(fmt::format("depth of 32×24 px in frame '{}', colour of 64×48 in 'c'", frame)),
              HasSubstr("camera_info"), HasSubstr("align_depth")));
  registration.set_depth_lens(lens(32, 24));
  for (const char* frame : {"c", "d"})
    EXPECT_THAT(registration.depth({16, 12}, frame, 0).error(), HasSubstr("depth's camera_info is of 32×24"));
}

TEST(PictureRegistration, SaysWhereNoTfJoinsTheFrames) {
  PictureRegistration registration = registration_of();
  for (const cv::Size& size : {kSize, kHalf})
    EXPECT_THAT(registration.depth(size, "lost", 0).error(),
                AllOf(HasSubstr("in frame 'lost', colour in 'c', and no tf joins them"),
                      HasSubstr("publish tf_static"), HasSubstr("align_depth")));
}

TEST(PictureRegistration, KnowsWhichPicturesMayBeUsedThatCameBeforeTheLens) {
  for (const auto& [model, frame, are_used] : {std::tuple{geometry::LensModel::kPlumbBob, "c", true},
                                               {geometry::LensModel::kPlumbBob, "d", false},
                                               {geometry::LensModel::kEquidistant, "c", false}}) {
    PictureRegistration registration(tf);
    EXPECT_FALSE(registration.color(kSize, "c").value());
    EXPECT_FALSE(registration.depth(kSize, frame, 0).value());
    EXPECT_TRUE(registration.leaves_early_pictures());
    registration.set_color_lens(lens(64, 48, model), "c");
    EXPECT_EQ(registration.leaves_early_pictures(), are_used);
  }
}

TEST(PictureRegistration, RefusesPicturesThatAreNotOfTheirCameraInfo) {
  PictureRegistration registration = registration_of();
  EXPECT_THAT(registration.color(kHalf, "c").error(),
              HasSubstr("pictures of 32×24 px, but camera_info is of 64×48"));
}

}  // namespace
}  // namespace rds::image
