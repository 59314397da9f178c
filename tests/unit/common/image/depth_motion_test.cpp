// SPDX-License-Identifier: Apache-2.0
#include "common/image/depth_motion.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace rds::image {
namespace {

using Eigen::Vector3d;
using geometry::CameraModel;
using geometry::Pose;

constexpr double kUnit = 0.0002;  // m

CameraModel camera(double distortion = 0) {
  return {.width = 200,
          .height = 150,
          .fx = 180,
          .fy = 175,
          .cx = 101,
          .cy = 73,
          .distortion = {distortion, 0, 0, 0, 0}};
}

void in_turn(std::size_t count, const std::function<void(std::size_t)>& part) {
  for (std::size_t i = 0; i < count; ++i) part(i);
}

/// A few degrees and centimetres, as between the two pictures of a camera in a hand.
Pose a_moment() {
  return geometry::make_pose(
      {0.012, -0.008, 0.01},
      Eigen::Quaterniond(Eigen::AngleAxisd(0.03, Vector3d(0.3, 1, -0.5).normalized())));
}

/// A wall that slopes, in the frame of the camera of the moment asked for.
double wall_m(const Vector3d& origin, const Vector3d& direction) {
  const Vector3d normal(-0.3, 0.15, 1);
  return (2 - normal.dot(origin)) / normal.dot(direction);
}

/// What a camera that stands at `here_from_camera` measures of the wall.
template <class Value>
DepthImage measured(const CameraModel& model, const Pose& here_from_camera) {
  cv::Mat_<Value> values(model.height, model.width);
  for (int y = 0; y < model.height; ++y)
    for (int x = 0; x < model.width; ++x) {
      const double z = wall_m(here_from_camera.translation(), here_from_camera.linear() * model.ray({x, y}));
      values(y, x) = static_cast<Value>(std::lround(z / kUnit));
    }
  return {values, static_cast<float>(kUnit), nullptr};
}

/// Largest difference [m] where the moved picture has depth, and the share of pixels where it has.
template <class Value>
std::pair<double, double> compare(const CameraModel& model, const Pose& taken_from_here) {
  const DepthImage moved =
      DepthMotion(model).moved(measured<Value>(model, taken_from_here.inverse()), taken_from_here, in_turn);
  const DepthImage expected = measured<Value>(model, Pose::Identity());
  EXPECT_EQ(moved.values.type(), expected.values.type());
  double worst = 0;
  double seen = 0;
  for (int y = 0; y < model.height; ++y)
    for (int x = 0; x < model.width; ++x) {
      if (!(moved.at(x, y) > 0)) continue;
      ++seen;
      worst = std::max(worst, std::abs(double{moved.at(x, y)} - expected.at(x, y)));
    }
  return {worst, seen / (model.width * model.height)};
}

TEST(DepthMotion, IsWhatTheCameraWouldHaveMeasured) {
  for (const double distortion : {0.0, 0.15}) {
    for (const Pose& pose : {a_moment(), a_moment().inverse()}) {
      const auto [worst, seen] = compare<std::uint16_t>(camera(distortion), pose);
      EXPECT_LT(worst, 0.01) << "half a pixel of the slope is 6 mm";
      EXPECT_GT(seen, 0.85) << "all but what comes into view";
    }
  }
  EXPECT_LT(compare<float>(camera(), a_moment()).first, 0.01);
}

TEST(DepthMotion, WithoutItTheDifferenceIsMuchLarger) {
  const DepthImage as_taken = measured<std::uint16_t>(camera(), a_moment().inverse());
  const DepthImage expected = measured<std::uint16_t>(camera(), Pose::Identity());
  EXPECT_GT(std::abs(as_taken.at(180, 20) - expected.at(180, 20)), 0.04F);
}

TEST(DepthMotion, APictureThatHardlyMovesIsTheSameOne) {
  const DepthImage picture = measured<std::uint16_t>(camera(), Pose::Identity());
  const Pose slow = geometry::make_pose({0.0005, 0, 0}, Eigen::Quaterniond::Identity());
  EXPECT_EQ(DepthMotion(camera()).moved(picture, slow, in_turn).values.data, picture.values.data);
}

TEST(DepthMotion, NothingIsMeasuredWhereNothingWas) {
  DepthImage picture = measured<float>(camera(), Pose::Identity());
  picture.values.colRange(0, 100).setTo(0);
  picture.values.colRange(150, 200).setTo(std::numeric_limits<float>::quiet_NaN());
  const DepthImage moved = DepthMotion(camera()).moved(picture, a_moment(), in_turn);
  EXPECT_EQ(cv::countNonZero(moved.values.colRange(0, 85)), 0);
  EXPECT_EQ(cv::countNonZero(moved.values.colRange(165, 200)), 0);
  EXPECT_GT(cv::countNonZero(moved.values.colRange(110, 140)), 4000);
}

TEST(DepthMotion, RefusesPicturesOfAnotherCamera) {
  const DepthMotion motion(camera());
  EXPECT_THROW(std::ignore = motion.moved({cv::Mat1w(10, 10), 0.001F, nullptr}, a_moment(), in_turn),
               std::invalid_argument);
  EXPECT_THROW(std::ignore = motion.moved({cv::Mat1b(150, 200), 0.001F, nullptr}, a_moment(), in_turn),
               std::invalid_argument);
}

}  // namespace
}  // namespace rds::image
