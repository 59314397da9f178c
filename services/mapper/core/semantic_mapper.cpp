// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/semantic_mapper.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "services/mapper/core/objects/object_extent.hpp"
#include "services/mapper/core/segmentation/gravity.hpp"

namespace rds::mapper {
namespace {
constexpr double kDegree = 3.14159265358979 / 180;
constexpr double kBytesPerMb = 1e6;
}  // namespace

SemanticMapper::SemanticMapper(MapperConfig config, std::uint64_t map_epoch,
                               std::unique_ptr<SpillStorage> storage)
    : config_(std::move(config)), map_epoch_(map_epoch), records_(std::move(storage)) {
  begin(map_epoch);
}

void SemanticMapper::reset(std::uint64_t map_epoch) {
  records_.clear();
  begin(map_epoch);
}

void SemanticMapper::begin(std::uint64_t map_epoch) {
  map_epoch_ = map_epoch;
  revision_ = start_.map ? 1 : 0;  // 0 is the empty map, which a reader needs not be told
  labels_ = start_.labels;
  keyframes_.clear();
  clock_ = final_clock_ = {};
  base_ = start_.map;
  map_ = std::make_unique<Map>(first_map());
  final_keyframes_ = 0;
  unsaved_final_.clear();
  has_checkpoint_ = false;
  boxes_waiting_ = false;
}

void SemanticMapper::know_surfaces(Map& map) const {
  const auto& tree = map.octree.tree();
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
    if (tree.isNodeOccupied(*leaf)) map.history.statics.know(leaf.getKey());
}

void SemanticMapper::go_on_from(Start start) {
  know_surfaces(*start.map);
  const std::uint64_t revision = revision_;
  start_ = std::move(start);
  reset(map_epoch_);
  revision_ = revision + 1;
}

MapDelta SemanticMapper::new_delta() const {
  MapDelta delta;
  delta.map_epoch = map_epoch_;
  delta.base_revision = revision_;
  delta.revision = revision_;
  delta.resolution = config_.octree.resolution_m;
  if (!keyframes_.empty()) {
    delta.keyframe_id = keyframes_.rbegin()->first;
    delta.stamp_ns = keyframes_.rbegin()->second.stamp_ns;
  }
  return delta;
}

std::shared_ptr<const std::vector<Eigen::Vector3f>> SemanticMapper::rays_of(
    const geometry::CameraModel& camera) const {
  if (!rays_ || !(camera == ray_camera_)) {
    rays_ = sample_rays(camera, config_.sampling.stride_px);
    ray_camera_ = camera;
  }
  return rays_;
}

/// Times follow the order of the ids, whatever the order of arrival.
std::int64_t SemanticMapper::time_of(std::uint64_t id, std::int64_t stamp_ns) {
  const auto next = keyframes_.upper_bound(id);
  if (next == keyframes_.end()) return clock_.go_to(stamp_ns).time_ns;
  return next->second.time_ns - (next->second.stamp_ns - stamp_ns);
}

/// As if all keyframes had arrived in order.
void SemanticMapper::set_times() {
  clock_ = final_clock_;
  for (auto& [id, keyframe] : keyframes_) keyframe.time_ns = clock_.go_to(keyframe.stamp_ns).time_ns;
}

MapDelta SemanticMapper::integrate(const KeyframeInput& input) {
  if (const auto fault = check(input)) throw std::invalid_argument(*fault);
  if (keyframes_.contains(input.id))
    throw std::invalid_argument(fmt::format("keyframe {}: is in the map already", input.id));
  auto record = make_record(input, config_.sampling, rays_of(input.camera));
  interpret(record, input.boxes, config_, labels_);
  record.time_ns = time_of(input.id, input.stamp_ns);
  keyframes_[input.id] = {input.stamp_ns, record.time_ns, input.map_from_camera, input.map_from_camera};
  records_.put(record);
  MapDelta delta = new_delta();
  delta.keyframe_id = input.id;
  delta.stamp_ns = input.stamp_ns;
  add_evidence(record, config_, labels_, *map_);
  update_map(record, map_->history, config_, labels_, scan_, *map_, delta);
  delta.revision = ++revision_;
  keep_within_limits();
  return delta;
}

std::optional<KeyframeRecord> SemanticMapper::record_of(std::uint64_t id) const {
  auto record = records_.get(id);
  if (!record) return record;
  record->rays = rays_of(record->camera);
  record->map_from_camera = keyframes_.at(id).pose;
  record->time_ns = keyframes_.at(id).time_ns;
  return record;
}

/// Its part of the map stays as it is, whatever corrections come.
void SemanticMapper::make_final(std::uint64_t id) {
  const auto record = record_of(id);
  if (!record) return lose(id);
  if (!base_ || base_ == start_.map) base_ = std::make_shared<Map>(first_map());
  MapDelta unused;
  add_evidence(*record, config_, labels_, *base_);
  update_map(*record, map_->history, config_, labels_, scan_, *base_, unused);
  if (id == keyframes_.begin()->first) final_clock_.go_to(record->stamp_ns);
  const auto keyframe = keyframes_.extract(id);
  has_checkpoint_ = has_checkpoint_ && records_.leave(id);
  if (has_checkpoint_)
    unsaved_final_[id] = keyframe.mapped();  // until a checkpoint has the final map with it
  else
    records_.erase(id);
  ++final_keyframes_;
}

void SemanticMapper::make_others_final(std::span<const KeyframePose> told) {
  std::vector<std::uint64_t> others;
  for (const auto& [id, keyframe] : keyframes_)
    if (!told.empty() && id < told.back().id && !std::ranges::binary_search(told, id, {}, &KeyframePose::id))
      others.push_back(id);
  for (const auto id : others) make_final(id);
}

void SemanticMapper::lose(std::uint64_t id) {
  keyframes_.erase(id);
  records_.erase(id);
  ++final_keyframes_;
  ++corrections_lost_;
}

void SemanticMapper::keep_within_limits() {
  const double limit = config_.correction.memory_mb * kBytesPerMb;
  while (static_cast<double>(records_.bytes_in_memory()) > limit && records_.in_memory() > 1) {
    if (records_.spill_oldest()) continue;
    make_final(records_.oldest_in_memory());
    ++corrections_lost_;
  }
  while (keyframes_.size() > static_cast<std::size_t>(config_.correction.max_keyframes))
    make_final(keyframes_.begin()->first);
}

bool SemanticMapper::set_boxes(std::uint64_t keyframe_id, std::span<const LabelledBox> boxes) {
  if (!keyframes_.contains(keyframe_id)) return false;
  auto record = record_of(keyframe_id);
  if (!record) {
    lose(keyframe_id);
    return false;
  }
  interpret(*record, boxes, config_, labels_);
  records_.put(*record);
  keep_within_limits();
  boxes_waiting_ = true;
  return true;
}

void SemanticMapper::take_poses(std::span<const KeyframePose> poses) {
  for (const auto& pose : poses) {
    const auto found = keyframes_.find(pose.id);
    if (found != keyframes_.end() && geometry::is_finite(pose.map_from_camera))
      found->second.pose = pose.map_from_camera;
  }
}

bool SemanticMapper::moved_enough() const {
  return std::ranges::any_of(keyframes_, [&](const auto& entry) {
    const geometry::Pose moved = entry.second.integrated_pose.inverse() * entry.second.pose;
    return moved.translation().norm() > config_.correction.min_translation_m ||
           geometry::rotation_angle_rad(moved.linear()) > config_.correction.min_rotation_deg * kDegree;
  });
}

MapDelta SemanticMapper::apply_poses(std::span<const KeyframePose> poses) {
  take_poses(poses);
  return boxes_waiting_ || moved_enough() ? rebuild() : new_delta();
}

MapDelta SemanticMapper::settle(std::span<const KeyframePose> poses) {
  take_poses(poses);
  return rebuild();
}

MapDelta SemanticMapper::rebuild() {
  set_times();
  auto fresh = std::make_unique<Map>(first_map());
  std::vector<std::uint64_t> lost;
  for (const auto& [id, keyframe] : keyframes_)
    if (const auto record = record_of(id)) {
      add_evidence(*record, config_, labels_, *fresh);
      progress_();
    } else {
      lost.push_back(id);
    }
  for (const auto id : lost) lose(id);
  for (auto& [id, keyframe] : keyframes_) {
    MapDelta unused;
    if (const auto record = record_of(id))
      update_map(*record, fresh->history, config_, labels_, scan_, *fresh, unused);
    keyframe.integrated_pose = keyframe.pose;
    progress_();
  }
  MapDelta delta = new_delta();
  map_->octree.difference(fresh->octree, delta);
  map_ = std::move(fresh);
  boxes_waiting_ = false;
  delta.revision = ++revision_;
  return delta;
}

Eigen::Vector3d SemanticMapper::up_in_map() const {
  if (config_.grid.up != "auto") return axis_of(config_.grid.up);
  if (start_.up) return *start_.up;
  std::vector<geometry::Pose> poses;
  std::vector<std::uint64_t> ids;
  for (const auto& [id, keyframe] : keyframes_) {
    ids.push_back(id);
    poses.push_back(keyframe.pose);
  }
  return estimate_up(poses, [&](std::size_t i) { return record_of(ids[i]); });
}

std::vector<MapObject> SemanticMapper::objects() const {
  auto objects = map_->objects.objects();
  fit_to_voxels(objects, map_->octree, labels_);
  return objects;
}

OccupancyGrid SemanticMapper::grid() const {
  return make_grid(tree(), up_in_map(), config_.grid);
}

std::vector<KeyframePose> SemanticMapper::keyframe_poses() const {
  std::vector<KeyframePose> poses;
  for (const auto& [id, keyframe] : keyframes_) poses.push_back({id, keyframe.stamp_ns, keyframe.pose});
  return poses;
}

}  // namespace rds::mapper
