// SPDX-License-Identifier: Apache-2.0
// An object keeps its id, whatever happens to the keyframes that have seen it.
#include <map>
#include <random>

#include <gmock/gmock.h>

#include "services/mapper/core/objects/object_json.hpp"
#include "tests/unit/services/mapper/core/lasting_storage.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::LastingStorage;
using test::SyntheticKeyframe;
using Ids = std::map<std::string, std::uint64_t>;  // by label: each thing has its own

struct Thing {
  const char* label;
  cv::Rect px;
};
const std::array<Thing, 3> kThings{
    {{"chair", {10, 60, 70, 90}}, {"sofa", {120, 90, 80, 70}}, {"tvmonitor", {240, 60, 60, 60}}}};

MapperConfig coarse() {
  MapperConfig config;
  config.sampling.stride_px = 4;
  config.octree.resolution_m = 0.1;
  return config;
}

/// Keyframes of three things, corrections, culled keyframes, late boxes and restarts, as a seed says.
class Schedule {
 public:
  explicit Schedule(unsigned seed) : random_(seed) {
    for (int i = 0; i < 4; ++i) integrate(true);
  }

  void one_event() {
    const double which = uniform();
    if (which < 0.35) return integrate(uniform() < 0.7);
    if (which < 0.5) return correct(0.03);
    if (which < 0.65) return correct(1.0);
    if (which < 0.75) return give_late_boxes();
    if (which < 0.85) return cull();
    restart();
  }
  [[nodiscard]] Ids ids() const {
    Ids ids;
    for (const MapObject& object : mapper_->map().objects()) {
      EXPECT_TRUE(ids.emplace(object.label, object.id).second) << to_json(mapper_->map().objects());
    }
    return ids;
  }

 private:
  double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  geometry::Pose somewhere(double reach_m) {
    geometry::Pose pose(Eigen::AngleAxisd(0.2 * (uniform() - 0.5), Eigen::Vector3d::UnitY()));
    pose.translation() = reach_m * Eigen::Vector3d(uniform(), uniform(), uniform());
    return pose;
  }
  KeyframeInput keyframe(std::uint64_t id, bool with_boxes) {
    SyntheticKeyframe made(id);
    const auto first = static_cast<std::size_t>(random_() % kThings.size());
    for (std::size_t i = 0; i < kThings.size(); ++i) {
      const Thing& thing = kThings[(first + i) % kThings.size()];  // in another order each time
      made.rectangle(thing.px, 2.0);
      if (with_boxes) made.box(thing.label, thing.px, false);
    }
    KeyframeInput input = made.pose(drift_);
    return input;
  }
  void integrate(bool with_boxes) {
    mapper_->integrate(keyframe(next_, with_boxes));
    if (!with_boxes) bare_.push_back(next_);
    ++next_;
  }
  /// All that can still move does so with the camera, which had drifted; little once a part is final.
  void correct(double reach_m) {
    const Eigen::Vector3d before = drift_.translation();
    if (has_final_)
      drift_.translation() = before + 0.02 * (somewhere(1).translation() - Eigen::Vector3d::Constant(0.5));
    else
      drift_ = somewhere(reach_m);
    std::vector<KeyframePose> poses;
    for (const auto& pose : mapper_->archive().poses()) poses.push_back({pose.id, pose.stamp_ns, drift_});
    mapper_->apply_poses(poses);
    while (mapper_->is_correcting()) mapper_->go_on_correcting();
  }
  void give_late_boxes() {
    if (bare_.empty()) return;
    const std::uint64_t id = bare_.back();
    bare_.pop_back();
    const auto boxes = *keyframe(id, true).boxes;
    mapper_->set_boxes(id, boxes);
    mapper_->apply_poses({});
  }
  void cull() {
    auto poses = mapper_->archive().poses();
    if (poses.size() < 3) return;
    poses.erase(poses.begin() + static_cast<std::ptrdiff_t>(random_() % (poses.size() - 1)));
    mapper_->make_others_final(poses);
    has_final_ = true;
  }
  void restart() {
    auto newer = mapper_->checkpoint();
    ASSERT_TRUE(newer);
    if (!newer->final_map) newer->final_map = std::move(checkpoint_.final_map);
    checkpoint_ = std::move(*newer);
    mapper_ = std::make_unique<SemanticMapper>(coarse(), 1, std::make_unique<LastingStorage>(rows_));
    const auto restored = mapper_->restore(checkpoint_);
    ASSERT_TRUE(restored) << restored.error();
  }

  std::mt19937 random_;
  LastingStorage::Rows rows_;
  std::unique_ptr<SemanticMapper> mapper_ =
      std::make_unique<SemanticMapper>(coarse(), 1, std::make_unique<LastingStorage>(rows_));
  MapCheckpoint checkpoint_;
  std::uint64_t next_ = 0;
  std::vector<std::uint64_t> bare_;
  geometry::Pose drift_ = geometry::Pose::Identity();
  bool has_final_ = false;
};

TEST(ObjectIdentities, SurviveEveryCorrectionCullingAndRestart) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    Schedule schedule(seed);
    const Ids first = schedule.ids();
    ASSERT_EQ(first.size(), kThings.size());
    for (int event = 0; event < 12; ++event) {
      schedule.one_event();
      ASSERT_EQ(schedule.ids(), first) << "seed " << seed << ", event " << event;
    }
  }
}

const cv::Rect kSeat(100, 80, 80, 80);

KeyframeInput seat(std::uint64_t id, const char* label, double x_m) {
  geometry::Pose pose = geometry::Pose::Identity();
  pose.translation().x() = x_m;
  return SyntheticKeyframe(id).rectangle(kSeat, 2.0).box(label, kSeat, false).pose(pose);
}

std::vector<KeyframePose> all_at(std::uint64_t count, double x_m) {
  std::vector<KeyframePose> poses;
  for (std::uint64_t id = 0; id < count; ++id) poses.push_back({id, 0, geometry::Pose::Identity()});
  for (auto& pose : poses) pose.map_from_camera.translation().x() = x_m;
  return poses;
}

TEST(ObjectIdentities, OfTwoThatAreFoundToBeOneTheOlderStays) {
  SemanticMapper mapper(coarse());
  for (std::uint64_t id = 0; id < 2; ++id) mapper.integrate(seat(id, "chair", 0));
  for (std::uint64_t id = 2; id < 9; ++id) mapper.integrate(seat(id, "chair", 2));  // drift
  ASSERT_EQ(mapper.map().objects().size(), 2U);
  mapper.apply_poses(all_at(9, 0));
  const auto objects = mapper.map().objects();
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_EQ(objects[0].id, 1U);
  EXPECT_EQ(objects[0].observations, 9U);
}

TEST(ObjectIdentities, OfTwoThatWereTakenForOneTheLargerPartKeepsIt) {
  SemanticMapper mapper(coarse());
  for (std::uint64_t id = 0; id < 8; ++id) mapper.integrate(seat(id, "chair", 0));
  auto poses = all_at(8, 0);
  for (std::size_t i = 0; i < 3; ++i) poses[i].map_from_camera.translation().x() = -2;
  mapper.apply_poses(poses);
  const auto objects = mapper.map().objects();
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].id, 1U);
  EXPECT_EQ(objects[0].observations, 5U);
  EXPECT_EQ(objects[1].id, 2U);
}

TEST(ObjectIdentities, ANewObjectNeverGetsAnIdThatWasGiven) {
  SemanticMapper mapper(coarse());
  for (std::uint64_t id = 0; id < 2; ++id) mapper.integrate(seat(id, "chair", 0));
  for (std::uint64_t id = 2; id < 4; ++id) mapper.integrate(seat(id, "chair", 2));
  mapper.apply_poses(all_at(4, 0));
  for (std::uint64_t id = 4; id < 6; ++id) mapper.integrate(seat(id, "chair", 4));
  const auto objects = mapper.map().objects();
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].id, 1U);
  EXPECT_EQ(objects[1].id, 3U) << "2 was that of one that was found to be 1";
}

TEST(ObjectIdentities, OutlastASavedMapAndWhatComesAfterIt) {
  SemanticMapper before(coarse());
  for (std::uint64_t id = 0; id < 2; ++id) before.integrate(seat(id, "sofa", 3));
  for (std::uint64_t id = 2; id < 5; ++id) before.integrate(seat(id, "chair", 0));
  SemanticMapper after(coarse());
  ASSERT_TRUE(test::start_from(after, test::saved_bytes(before), coarse()));
  for (std::uint64_t id = 0; id < 3; ++id) after.integrate(seat(id, "chair", 0.02));
  after.apply_poses(all_at(3, 0));
  const auto objects = after.map().objects();
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].label, "sofa");
  EXPECT_EQ(objects[0].id, 1U);
  EXPECT_EQ(objects[1].label, "chair");
  EXPECT_EQ(objects[1].id, 2U);
  EXPECT_EQ(objects[1].observations, 6U);
}

}  // namespace
}  // namespace rds::mapper
