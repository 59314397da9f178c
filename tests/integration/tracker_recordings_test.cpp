// SPDX-License-Identifier: Apache-2.0
// The tracker core alone, in lockstep and without a loop closer, on recordings.
#include <gtest/gtest.h>

#include "tests/support/shared_data.hpp"
#include "tests/support/tracker_sequence.hpp"
#include "tools/evaluation/trajectory_evaluation.hpp"

namespace rds::test {
namespace {

struct Figures {
  double tracked = 0;  // share of the recording's frames
  double ate_live_m = 0;
  double ate_final_m = 0;
};

image::TumDataset open(const std::filesystem::path& folder) {
  auto dataset = image::TumDataset::open(folder);
  if (!dataset) throw std::runtime_error(dataset.error());
  return std::move(*dataset);
}

double ate_m(const image::TumDataset& dataset, const std::vector<geometry::StampedPose>& estimate) {
  const auto errors = evaluation::evaluate_trajectory(dataset.ground_truth().value(), estimate);
  return errors.value().absolute_m.rmse;
}

TrackerSequence tracked(const image::TumDataset& dataset, const TrackerSequenceOptions& options,
                        std::size_t start, std::size_t frames, const tracker::TrackerConfig& config = {}) {
  cv::setNumThreads(1);
  TrackerSequence sequence(options, dataset, config);
  const std::size_t end = std::min(frames, dataset.frames().size() - start) + start;
  for (std::size_t i = start; i < end; ++i) sequence.step(i);
  return sequence;
}

Figures figures(const std::filesystem::path& folder, const TrackerSequenceOptions& options = {},
                const tracker::TrackerConfig& config = {}) {
  const image::TumDataset dataset = open(folder);
  const TrackerSequence sequence = tracked(dataset, options, 0, dataset.frames().size(), config);
  return {static_cast<double>(sequence.live().size()) / static_cast<double>(dataset.frames().size()),
          ate_m(dataset, sequence.live()), ate_m(dataset, sequence.optimized())};
}

/// With a sensor that measures so far only.
Figures figures_within(const std::filesystem::path& folder, double range_m, bool triangulate) {
  tracker::TrackerConfig config;
  config.depth.max_depth_m = range_m;
  config.depth.triangulate = triangulate;
  return figures(folder, {}, config);
}

/// Two runs over the same stretch, compared bit by bit.
void expect_same_bytes_twice(const std::filesystem::path& folder, const TrackerSequenceOptions& options) {
  const image::TumDataset dataset = open(folder);
  const TrackerSequence a = tracked(dataset, options, 100, 80);
  const TrackerSequence b = tracked(dataset, options, 100, 80);
  EXPECT_GT(a.keyframes_made(), 3);
  EXPECT_EQ(a.tracker().map().points().size(), b.tracker().map().points().size());
  const auto optimized_a = a.optimized();
  const auto optimized_b = b.optimized();
  ASSERT_EQ(a.live().size(), b.live().size());
  for (std::size_t i = 0; i < a.live().size(); ++i) {
    EXPECT_EQ(a.live()[i].map_from_camera.matrix(), b.live()[i].map_from_camera.matrix()) << i;
    EXPECT_EQ(optimized_a[i].map_from_camera.matrix(), optimized_b[i].map_from_camera.matrix()) << i;
  }
}

TEST(TrackerRecordings, TurningCameraInAnOffice) {
  RDS_REQUIRE_SHARED("data/tum_fr1_rpy");
  const Figures f = figures(shared() / "data/tum_fr1_rpy");
  EXPECT_EQ(f.tracked, 1);
  EXPECT_LE(f.ate_live_m, 0.024);
  EXPECT_LE(f.ate_final_m, 0.018);
}

TEST(TrackerRecordings, CameraThatComesBackInARoom) {
  const TestRecording room = recording_of_a_room();
  const Figures f = figures(room.folder);
  EXPECT_EQ(f.tracked, 1);
  EXPECT_LE(f.ate_live_m, room.bound(0.050, 0.010));
  EXPECT_LE(f.ate_final_m, room.bound(0.045, 0.010));
}

/// For up to two seconds people fill the picture: then a lost frame is right, and a pose would be invented
/// (relocalising with 40 inliers instead of 50 gives 16 more poses, off by up to 0.3 m).
TEST(TrackerRecordings, PeopleInARoomKnownWithEveryFrame) {
  const TestRecording room = recording_with_people();
  const Figures f = figures(room.folder, {.truth_boxes = true});
  EXPECT_GE(f.tracked, room.bound(0.93, 1));
  EXPECT_LE(f.ate_live_m, room.bound(0.09, 0.010));
  EXPECT_LE(f.ate_final_m, room.bound(0.08, 0.010));
}

/// On a floor the room behind a door is farther than this sensor measures.
TEST(TrackerRecordings, PointsWithoutDepthLeadThroughDoors) {
  const auto floor = rendered_recording("floor");
  EXPECT_GE(figures_within(floor, 2.5, true).tracked, 0.95);
  EXPECT_LE(figures_within(floor, 2.5, false).tracked, 0.5) << "it needs no points without depth";
}

/// Two thirds of the features have no depth.
TEST(TrackerRecordings, MostOfARoomBeyondTheSensorsRange) {
  RDS_REQUIRE_SHARED("data/7scenes_kitchen");
  const auto room = shared() / "data/7scenes_kitchen";
  const Figures with = figures_within(room, 1.5, true);
  const Figures without = figures_within(room, 1.5, false);
  EXPECT_EQ(with.tracked, 1);
  EXPECT_GE(with.tracked, without.tracked);
  EXPECT_LE(with.ate_live_m, 0.10);
  EXPECT_LE(with.ate_live_m, 1.1 * without.ate_live_m) << "where the camera is not lost without, either";
}

TEST(TrackerRecordings, SameBytesTwice) {
  const bool recorded = why_not_shared("data/tum_fr1_rpy").empty();
  expect_same_bytes_twice(recorded ? shared() / "data/tum_fr1_rpy" : recording_of_a_room().folder, {});
}

TEST(TrackerRecordings, SameBytesTwiceWithPeople) {
  expect_same_bytes_twice(recording_with_people().folder, {.truth_boxes = true, .late_boxes = true});
}

}  // namespace
}  // namespace rds::test
