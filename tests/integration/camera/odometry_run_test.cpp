// SPDX-License-Identifier: Apache-2.0
// Whole runs of the real processes with a robot's odometry beside the pictures: the lens is covered for three
// seconds, and the odometry is right, apart from scale, noise and slip, or has nothing to do with the camera.
#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>

#include "common/geometry/trajectory.hpp"
#include "tests/integration/run_support.hpp"
#include "tests/support/disturbed_dataset.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/sensors/dead_reckoning.hpp"

namespace rds::test {
namespace {

using geometry::Pose;
using geometry::StampedPose;

constexpr std::size_t kFrames = 300;  // of the twelve seconds
constexpr FrameRange kCovered{.first = 190, .count = 90};
constexpr double kMaxErrorM = 0.03;
constexpr double kMaxHarm = 1.02;  // ATE with odometry to ATE without, …
constexpr double kSameM = 0.0002;  // … or as near as that: a tenth of the error of a rendered room

std::vector<StampedPose> trajectory_of(const std::filesystem::path& file) {
  return geometry::read_trajectory(file).value();
}

class OdometryRun : public testing::Test {
 protected:
  OdometryRun() {
    make_excerpt(rendered_recording("room_empty"), place / "whole", kFrames);
    make_blacked_out(place / "whole", place / "covered", kCovered, Darkened::kColorAndDepth);
    truth = trajectory_of(place / "whole/groundtruth.txt");
  }
  /// @return states of the frames.
  std::vector<std::string> run_of(const std::string& dataset, const std::string& out,
                                  const std::string& odometry) {
    std::vector<std::string> arguments{"--rate", "max", "--no-dynamics"};
    if (!odometry.empty()) arguments.push_back("--odometry=" + (place / odometry).string());
    const ProcessResult result = run(place / dataset, place / out, arguments);
    if (result.status != 0) throw std::runtime_error(result.standard_error);
    std::istringstream frames(read_text(place / out / "frames.csv"));
    std::vector<std::string> states;
    std::string line;
    std::getline(frames, line);
    while (std::getline(frames, line)) {
      const auto comma = line.find(',') + 1;
      states.push_back(line.substr(comma, line.find(',', comma) - comma));
    }
    return states;
  }
  [[nodiscard]] double ate_m(const std::string& out) {
    return score(place / "whole", place / out)["ate_final"].get<double>();
  }
  /// Of the motion since the frame before the lens was covered, the largest that was carried on.
  [[nodiscard]] double carried_error_m(const std::string& out) const {
    const auto live = trajectory_of(place / out / "trajectory.txt");
    const auto motion = [](const Pose& from, const Pose& to) { return Pose(from.inverse() * to); };
    const auto& before = live.at(kCovered.first - 1);
    double largest_m = 0;
    for (std::size_t i = kCovered.first; i < kCovered.first + kCovered.count; ++i) {
      const Pose told = motion(before.map_from_camera, live.at(i).map_from_camera);
      const Pose expected = motion(geometry::interpolate(truth, before.stamp_ns),
                                   geometry::interpolate(truth, live.at(i).stamp_ns));
      largest_m = std::max(largest_m, (told.translation() - expected.translation()).norm());
    }
    return largest_m;
  }

  TemporaryFolder place;
  std::vector<StampedPose> truth;
};

TEST_F(OdometryRun, CarriesACoveredCameraOnAndDoesNoHarmOtherwise) {
  // What slips while nothing is seen cannot be seen either: unit tests look at what is told of it.
  const auto told = simulator::dead_reckoning(truth, {.slips_per_second = 0}, 1);
  ASSERT_TRUE(geometry::write_trajectory(place / "odometry.txt", told));
  const auto covered = run_of("covered", "covered_out", "odometry.txt");
  ASSERT_EQ(covered.size(), kFrames);
  EXPECT_EQ(std::ranges::count(covered, "LOST"), 0);
  for (std::size_t i = 0; i < kCovered.count; ++i) EXPECT_EQ(covered[kCovered.first + i], "WEAK") << i;
  EXPECT_EQ(covered[kCovered.first + kCovered.count], "RELOCALISED");
  EXPECT_LE(carried_error_m("covered_out"), kMaxErrorM);

  run_of("whole", "without_out", "");
  const auto with = run_of("whole", "with_out", "odometry.txt");
  EXPECT_EQ(std::ranges::count(with, "TRACKING"), std::ssize(with));
  EXPECT_LE(ate_m("with_out"), std::max(kMaxHarm * ate_m("without_out"), ate_m("without_out") + kSameM));
}

TEST_F(OdometryRun, ThatIsFrozenCarriesNothingOn) {
  std::vector<StampedPose> frozen = truth;
  for (StampedPose& pose : frozen) pose.map_from_camera = Pose::Identity();
  ASSERT_TRUE(geometry::write_trajectory(place / "frozen.txt", frozen));
  const auto covered = run_of("covered", "frozen_out", "frozen.txt");
  for (std::size_t i = 0; i < kCovered.count; ++i) EXPECT_EQ(covered.at(kCovered.first + i), "LOST") << i;
}

}  // namespace
}  // namespace rds::test
