// SPDX-License-Identifier: Apache-2.0
// Whole runs of the real processes on rendered recordings, whose truth is exact: each way of moving the
// camera with people in the picture, and ways that close a loop: around the room, and through a floor.
#include <algorithm>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "common/geometry/trajectory.hpp"
#include "tests/integration/run_support.hpp"
#include "tests/support/disturbed_dataset.hpp"
#include "tests/support/grid/grid_walls.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

/// What `rds eval` must say of a recording and its twin without people.
struct RenderedFigures {
  std::string name;
  std::string bus;
  double max_ate_m;
  double min_box_recall;
  double max_residue;
  double min_static_recall;
};

void PrintTo(const RenderedFigures& figures, std::ostream* out) {
  *out << figures.name;
}

/// How far the map's z is from up: truth's frame is level.
double map_tilt_deg(const std::filesystem::path& dataset, const std::filesystem::path& out) {
  const auto truth = geometry::read_trajectory(dataset / "groundtruth.txt").value();
  const auto keyframes = geometry::read_trajectory(out / "keyframes.txt").value();
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const auto& keyframe : keyframes) {
    const auto true_one = std::ranges::min_element(truth, {}, [&](const geometry::StampedPose& pose) {
      return std::abs(pose.stamp_ns - keyframe.stamp_ns);
    });
    up += keyframe.map_from_camera.linear() * true_one->map_from_camera.linear().transpose() *
          Eigen::Vector3d::UnitZ();
  }
  return std::acos(up.normalized().z()) * 180 / std::numbers::pi;
}

class RenderedRun : public ::testing::TestWithParam<RenderedFigures> {};

TEST_P(RenderedRun, KeepsPeopleOutOfPoseAndMap) {
  const RenderedFigures& expected = GetParam();
  const TemporaryFolder place;
  const auto dataset = rendered_recording(expected.name);
  const ProcessResult result = run(dataset, place / "out", {"--rate", "max", "--bus", expected.bus});
  ASSERT_EQ(result.status, 0) << result.standard_error;
  const auto figures = score(dataset, place / "out", rendered_recording(expected.name + "_empty"),
                             {"--align", "orientations"});  // two of the cameras hardly leave their place
  EXPECT_EQ(figures["tracked"].get<double>(), 1.0);
  EXPECT_LE(figures["ate_final"].get<double>(), expected.max_ate_m);
  EXPECT_GE(figures["box_recall"].get<double>(), expected.min_box_recall);
  EXPECT_LE(figures["residue"].get<double>(), expected.max_residue);
  EXPECT_LE(map_tilt_deg(dataset, place / "out"), 1.5);
  EXPECT_GE(figures["static_recall"].get<double>(), expected.min_static_recall);
  EXPECT_GE(figures["map_precision"].get<double>(), 0.97);
  const double walls = walls_over_occupied(rendered_recording(expected.name + "_empty"), place / "out");
  fmt::print("{}: {:.3f} of the walls' points over occupied cells\n", expected.name, walls);
  EXPECT_GE(walls, 0.97);
}

INSTANTIATE_TEST_SUITE_P(Path, RenderedRun,
                         ::testing::Values(RenderedFigures{"room", "fastdds", 0.010, 0.80, 0.01, 0.97},
                                           RenderedFigures{"rpy", "cyclonedds", 0.010, 0.80, 0.02, 0.97},
                                           RenderedFigures{"halfsphere", "fastdds", 0.010, 0.80, 0.01, 0.97},
                                           RenderedFigures{"static", "cyclonedds", 0.005, 0.80, 0.02, 0.97}),
                         [](const auto& path) { return path.param.name; });

/// What a recording that comes back to a place leaves behind. @param joined  the tracker listens to the loop
/// closer.
nlohmann::json lap(const std::string& recording, const std::filesystem::path& place, bool joined) {
  const auto dataset = rendered_recording(recording);
  const auto config = place / "config.yaml";
  const auto out = place / (joined ? "joined" : "open");
  write_text(config, joined ? "{}\n" : "tracker: {loop_closer: false}\n");
  const auto result = run(dataset, out, {"--rate", "max", "--no-dynamics", "--config", config.string()});
  if (result.status != 0) throw std::runtime_error(result.standard_error);
  auto figures = score(dataset, out, dataset);
  figures["loops_closed"] = nlohmann::json::parse(read_text(out / "summary.json"))["loops_closed"];
  return figures;
}

void expect_joined(const nlohmann::json& open, const nlohmann::json& joined, double max_ate_m) {
  EXPECT_EQ(open["loops_closed"].get<int>(), 0);
  EXPECT_GE(joined["loops_closed"].get<int>(), 1);
  EXPECT_EQ(joined["loops_false"].get<int>(), 0);
  EXPECT_EQ(open["tracked"].get<double>(), 1.0);
  EXPECT_EQ(joined["tracked"].get<double>(), 1.0);
  EXPECT_LE(joined["ate_final"].get<double>(), max_ate_m);
  EXPECT_LT(joined["ate_final"].get<double>(), open["ate_final"].get<double>());
  EXPECT_GE(joined["static_recall"].get<double>(), 0.97);
  EXPECT_GE(joined["map_precision"].get<double>(), 0.99);
}

TEST(RenderedLoop, IsJoinedThroughAllProcesses) {
  const TemporaryFolder place;
  const auto open = lap("loop", place.path(), false);
  const auto joined = lap("loop", place.path(), true);
  expect_joined(open, joined, 0.0045);
  // Where a lap is not joined, the walls that are seen at its start and end stand twice.
  EXPECT_LT(joined["map_occupied"].get<int>(), open["map_occupied"].get<int>());
  EXPECT_GE(joined["loops_true"].get<int>(), 1);
}

/// A robot leaves a corridor through a door into a room, and comes back to it from another one: nowhere is it
/// lost, and both visits are one room of the map.
TEST(RenderedFloor, IsTrackedThroughDoorsAndJoined) {
  const TemporaryFolder place;
  const auto open = lap("floor", place.path(), false);
  const auto joined = lap("floor", place.path(), true);
  expect_joined(open, joined, 0.008);
  // It drifts by a fifth of a voxel, which makes no second layer of walls yet.
  EXPECT_LT(joined["map_occupied"].get<int>(), 1.01 * open["map_occupied"].get<int>());
}

/// The lens is covered for 5 s and uncovered where nothing was seen before: what comes then is mapped beside
/// the map, and put in its place when the corridor of the beginning is seen again.
TEST(RenderedFloor, ACoveredLensBeginsASubmapThatIsJoined) {
  constexpr FrameRange kCovered{.first = 140, .count = 50};
  const TemporaryFolder place;
  const auto dataset = rendered_recording("floor");
  const auto covered = place / "covered";
  make_blacked_out(dataset, covered, kCovered, Darkened::kColorAndDepth);
  std::filesystem::copy_file(dataset / "truth.ot", covered / "truth.ot");
  const auto result = run(covered, place / "out", {"--rate", "max", "--no-dynamics", "--bus", "cyclonedds"});
  ASSERT_EQ(result.status, 0) << result.standard_error;
  const auto frames = nlohmann::json::parse(read_text(place / "out/summary.json"))["frames"];
  EXPECT_EQ(frames["lost"].get<std::size_t>(), kCovered.count);
  EXPECT_GT(frames["in_submaps"].get<int>(), 100);
  EXPECT_GT(frames["tracked"].get<std::size_t>(), kCovered.first) << "in the map again";
  const auto trajectory = geometry::read_trajectory(place / "out/trajectory_optimized.txt").value();
  EXPECT_EQ(trajectory.size() + kCovered.count, frames["played"].get<std::size_t>());
  const auto figures = score(covered, place / "out", dataset);
  EXPECT_LE(figures["ate_final"].get<double>(), 0.010);
  EXPECT_GE(figures["static_recall"].get<double>(), 0.97);
  EXPECT_GE(figures["map_precision"].get<double>(), 0.99);
}

}  // namespace
}  // namespace rds::test
