// SPDX-License-Identifier: Apache-2.0
#include "common/image/depth_registration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <gtest/gtest.h>

namespace rds::image {
namespace {

using Eigen::Vector3d;
using geometry::Lens;
using geometry::LensModel;
using geometry::Pose;

constexpr double kUnit = 0.001;  // m

Lens lens_of(int width, int height, LensModel model = LensModel::kPlumbBob,
             const std::array<double, 8>& coefficients = {}) {
  return {.width = width,
          .height = height,
          .fx = 0.9 * width,
          .fy = 0.9 * width,
          .cx = width / 2.0 - 0.5,
          .cy = height / 2.0 - 0.5,
          .model = model,
          .coefficients = coefficients};
}

/// Depth beside colour: 5 cm to its left, and turned a little.
Pose color_from_depth() {
  return geometry::make_pose({-0.05, 0.004, -0.002},
                             Eigen::Quaterniond(Eigen::AngleAxisd(0.03, Vector3d(0.3, 1, 0.2).normalized())));
}

/// A wall that slopes, and a board before it; in the colour camera's frame.
struct Room {
  bool has_board = false;
  static constexpr double kBoardM = 1.1;

  /// Along a ray from `origin`: how often `direction` it goes.
  [[nodiscard]] double hit(const Vector3d& origin, const Vector3d& direction) const {
    const Vector3d normal(-0.4, 0.1, 1);  // of the wall: normal · p = 2.2
    const double wall = (2.2 - normal.dot(origin)) / normal.dot(direction);
    const double board = (kBoardM - origin.z()) / direction.z();
    const Vector3d at = origin + board * direction;
    const bool is_on_board = has_board && std::abs(at.x() + 0.05) < 0.2 && std::abs(at.y()) < 0.25;
    return is_on_board ? std::min(wall, board) : wall;
  }
  /// What a camera measures at a pixel [m]; 0 where its lens has no ray.
  [[nodiscard]] double depth(const Lens& lens, const Pose& room_from_camera, double x, double y) const {
    const auto ray = lens.ray({x, y});
    return ray ? hit(room_from_camera.translation(), room_from_camera.linear() * *ray) : 0;
  }
  [[nodiscard]] DepthImage seen_by(const Lens& lens, const Pose& room_from_camera) const {
    cv::Mat1w values(lens.height, lens.width);
    for (int y = 0; y < lens.height; ++y)
      for (int x = 0; x < lens.width; ++x)
        values(y, x) = static_cast<std::uint16_t>(std::lround(depth(lens, room_from_camera, x, y) / kUnit));
    return {values, static_cast<float>(kUnit), nullptr};
  }
};

struct Cameras {
  Lens depth;
  Lens color;
};

class DepthOfAnotherCamera : public ::testing::TestWithParam<Cameras> {};

TEST_P(DepthOfAnotherCamera, IsThatOfASlopeWithoutHoles) {
  const auto& [depth, color] = GetParam();
  const Room room;
  const DepthImage registered = DepthRegistration(depth, color.camera())
                                    .depth(room.seen_by(depth, color_from_depth()), color_from_depth());
  ASSERT_EQ(registered.values.size(), cv::Size(color.width, color.height));
  ASSERT_EQ(registered.values.type(), CV_16UC1);
  double sum = 0;
  int count = 0;
  for (int y = color.height / 8; y < color.height * 7 / 8; ++y)  // both see that
    for (int x = color.width / 8; x < color.width * 7 / 8; ++x) {
      const double error =
          static_cast<double>(registered.at(x, y)) - room.depth(color, Pose::Identity(), x, y);
      ASSERT_LT(std::abs(error), 0.01) << x << " " << y << ": a pixel of depth on the slope";
      sum += error;
      ++count;
    }
  EXPECT_LT(std::abs(sum / count), 0.0015) << "not to one side, but for the nearest of two";
}

INSTANTIATE_TEST_SUITE_P(
    Of, DepthOfAnotherCamera,
    ::testing::Values(
        Cameras{lens_of(160, 120), lens_of(320, 240)},  // coarser than colour
        Cameras{lens_of(120, 90), lens_of(400, 300)}, Cameras{lens_of(320, 240), lens_of(160, 120)},
        Cameras{lens_of(160, 120, LensModel::kPlumbBob, {.1, -.05, .002, -.001, .01}),
                lens_of(320, 240, LensModel::kPlumbBob, {-.08, .03, .001, .002, 0})},
        Cameras{lens_of(160, 120, LensModel::kRationalPolynomial, {.3, -.1, .001, .002, .02, .2, .01, .005}),
                lens_of(320, 240)},
        Cameras{lens_of(160, 120, LensModel::kEquidistant, {.02, -.01, .003, -.001}), lens_of(320, 240)}));

enum class Sight : std::uint8_t { kBoard, kWall, kHidden };

/// What colour sees at a pixel: the board, the wall, or a part of it that the board hides from the depth
/// camera.
Sight sight_at(const Room& room, const Lens& color, int x, int y) {
  const double depth = room.depth(color, Pose::Identity(), x, y);
  if (depth == Room::kBoardM) return Sight::kBoard;
  const Vector3d point = *color.ray({static_cast<double>(x), static_cast<double>(y)}) * depth;
  const Vector3d eye = color_from_depth().translation();
  return room.hit(eye, point - eye) < 0.9 ? Sight::kHidden : Sight::kWall;
}

TEST(DepthRegistration, SeesWhatIsNearBeforeWhatItHidesToThePixel) {
  const Lens depth = lens_of(320, 240);
  const Lens color = lens_of(320, 240);
  const Room room{.has_board = true};
  const DepthImage registered = DepthRegistration(depth, color.camera())
                                    .depth(room.seen_by(depth, color_from_depth()), color_from_depth());
  std::map<Sight, int> compared;
  for (int y = 30; y < 210; ++y)
    for (int x = 40; x < 280; ++x) {
      const Sight sight = sight_at(room, color, x, y);
      bool is_at_an_edge = false;
      for (int i = 0; i < 9; ++i)
        is_at_an_edge = is_at_an_edge || sight_at(room, color, x + i % 3 - 1, y + i / 3 - 1) != sight;
      if (is_at_an_edge) continue;
      ++compared[sight];
      const double truth = sight == Sight::kHidden ? 0 : room.depth(color, Pose::Identity(), x, y);
      EXPECT_NEAR(registered.at(x, y), truth, 0.01) << x << " " << y;
    }
  EXPECT_GT(compared[Sight::kBoard], 5000);
  EXPECT_GT(compared[Sight::kWall], 5000);
  EXPECT_GT(compared[Sight::kHidden], 500) << "5 cm show behind the board's edge";
}

/// One measurement behind the other in the same pixel, in both orders of the rows and columns.
TEST(DepthRegistration, DrawsTheNearestOfSeveralWhateverTheirOrder) {
  const Lens lens = lens_of(64, 48);
  for (const double shift : {-0.05, 0.05}) {
    cv::Mat1w values(48, 64, std::uint16_t{3000});
    values(cv::Rect(24, 0, 16, 48)) = 500;
    const Pose moved = geometry::make_pose({shift, 0, 0}, Eigen::Quaterniond::Identity());
    const DepthImage registered =
        DepthRegistration(lens, lens.camera()).depth({values, 0.001F, nullptr}, moved);
    const int to = static_cast<int>(std::lround(shift / 0.5 * lens.fx));
    for (int x = 25; x < 39; ++x) EXPECT_FLOAT_EQ(registered.at(x + to, 20), 0.5F) << x;
  }
}

TEST(DepthRegistration, DrawsNothingThatIsNoMeasurement) {
  const Lens lens = lens_of(64, 48);
  const DepthRegistration registration(lens, lens.camera());
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float value :
       {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN(), infinity, -infinity, 1e30F}) {
    const auto result = registration.depth({cv::Mat1f(48, 64, value), 1, nullptr}, color_from_depth());
    EXPECT_EQ(cv::countNonZero(result.values), 0) << value;
  }
  const Pose behind = geometry::make_pose({0, 0, -2}, Eigen::Quaterniond::Identity());
  EXPECT_EQ(cv::countNonZero(
                registration.depth({cv::Mat1w(48, 64, std::uint16_t{1500}), 0.001F, nullptr}, behind).values),
            0);
  const Pose far = geometry::make_pose({0, 0, 2}, Eigen::Quaterniond::Identity());
  EXPECT_EQ(cv::countNonZero(
                registration.depth({cv::Mat1w(48, 64, std::uint16_t{64000}), 0.001F, nullptr}, far).values),
            0)
      << "more than the type holds";
}

TEST(DepthRegistration, KeepsTypeAndUnit) {
  const Lens lens = lens_of(64, 48);
  const DepthRegistration registration(lens, lens.camera());
  const auto result = registration.depth({cv::Mat1f(48, 64, 2.0F), 1, nullptr}, Pose::Identity());
  EXPECT_EQ(result.values.type(), CV_32FC1);
  EXPECT_FLOAT_EQ(result.at(30, 20), 2);
  const auto fine =
      registration.depth({cv::Mat1w(48, 64, std::uint16_t{10000}), 0.0002F, nullptr}, Pose::Identity());
  EXPECT_FLOAT_EQ(fine.at(30, 20), 2);
  EXPECT_THROW(static_cast<void>(registration.depth({cv::Mat1w(24, 64), 0.001F, nullptr}, Pose::Identity())),
               std::invalid_argument);
}

}  // namespace
}  // namespace rds::image
