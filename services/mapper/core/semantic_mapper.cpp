// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/semantic_mapper.hpp"

#include <algorithm>
#include <stdexcept>

#include "services/mapper/core/segmentation/gravity.hpp"

namespace rds::mapper {
namespace {

Map map_on(const std::shared_ptr<Map>& base, const MapperConfig& config) {
  return base ? *base : Map(config);
}

}  // namespace

SemanticMapper::SemanticMapper(MapperConfig config, std::uint64_t map_epoch,
                               std::unique_ptr<SpillStorage> storage)
    : config_(std::move(config)), map_(config_, map_epoch), archive_(config_, std::move(storage)) {}

void SemanticMapper::reset(std::uint64_t map_epoch) {
  archive_.clear();
  map_.epoch = map_epoch;
  map_.revision = saved_.map ? 1 : 0;
  map_.labels = saved_.labels;
  base_ = saved_.map;
  map_.content = std::make_unique<Map>(map_on(base_, config_));
  boxes_waiting_ = false;
}

void SemanticMapper::start_from(SavedMap saved) {
  const std::uint64_t revision = map_.revision;
  saved_ = std::move(saved);
  reset(map_.epoch);
  map_.revision = revision + 1;
}

MapDelta SemanticMapper::new_delta() const {
  MapDelta delta;
  delta.map_epoch = map_.epoch;
  delta.base_revision = map_.revision;
  delta.revision = map_.revision;
  delta.resolution = config_.octree.resolution_m;
  if (const auto& keyframes = archive_.keyframes(); !keyframes.empty()) {
    delta.keyframe_id = keyframes.rbegin()->first;
    delta.stamp_ns = keyframes.rbegin()->second.stamp_ns;
  }
  return delta;
}

MapDelta SemanticMapper::integrate(const KeyframeInput& input) {
  if (const auto fault = check(input)) throw std::invalid_argument(*fault);
  if (archive_.keyframes().contains(input.id))
    throw std::invalid_argument(fmt::format("keyframe {}: is in the map already", input.id));
  auto record = make_record(input, config_.sampling, archive_.rays_of(input.camera));
  interpret(record, input.boxes, config_, map_.labels);
  archive_.add(record);
  MapDelta delta = new_delta();
  delta.keyframe_id = input.id;
  delta.stamp_ns = input.stamp_ns;
  add_evidence(record, config_, map_.labels, *map_.content);
  update_map(record, map_.content->history, config_, map_.labels, scan_, *map_.content, delta);
  delta.revision = ++map_.revision;
  while (const auto id = archive_.spill()) make_final(*id);
  return delta;
}

/// Its part of the map stays as it is, whatever corrections come.
void SemanticMapper::make_final(std::uint64_t id) {
  const auto record = archive_.record(id);
  if (!record) return archive_.lose(id);
  if (!base_ || base_ == saved_.map) base_ = std::make_shared<Map>(map_on(base_, config_));
  MapDelta unused;
  add_evidence(*record, config_, map_.labels, *base_);
  update_map(*record, map_.content->history, config_, map_.labels, scan_, *base_, unused);
  archive_.make_final(*record);
}

void SemanticMapper::make_others_final(std::span<const KeyframePose> told) {
  std::vector<std::uint64_t> others;
  for (const auto& [id, keyframe] : archive_.keyframes())
    if (!told.empty() && id < told.back().id && !std::ranges::binary_search(told, id, {}, &KeyframePose::id))
      others.push_back(id);
  for (const auto id : others) make_final(id);
}

bool SemanticMapper::set_boxes(std::uint64_t keyframe_id, std::span<const LabelledBox> boxes) {
  if (!archive_.keyframes().contains(keyframe_id)) return false;
  auto record = archive_.record(keyframe_id);
  if (!record) {
    archive_.lose(keyframe_id);
    return false;
  }
  interpret(*record, boxes, config_, map_.labels);
  archive_.replace(*record);
  while (const auto id = archive_.spill()) make_final(*id);
  boxes_waiting_ = true;
  return true;
}

MapDelta SemanticMapper::apply_poses(std::span<const KeyframePose> poses) {
  archive_.set_poses(poses);
  return boxes_waiting_ || archive_.moved_enough() ? rebuild() : new_delta();
}

MapDelta SemanticMapper::settle(std::span<const KeyframePose> poses) {
  archive_.set_poses(poses);
  return rebuild();
}

MapDelta SemanticMapper::rebuild() {
  archive_.set_times();
  auto fresh = std::make_unique<Map>(map_on(base_, config_));
  std::vector<std::uint64_t> lost;
  for (const auto& [id, keyframe] : archive_.keyframes())
    if (const auto record = archive_.record(id)) {
      add_evidence(*record, config_, map_.labels, *fresh);
      progress_();
    } else {
      lost.push_back(id);
    }
  for (const auto id : lost) archive_.lose(id);
  for (const auto& [id, keyframe] : archive_.keyframes()) {
    MapDelta unused;
    if (const auto record = archive_.record(id))
      update_map(*record, fresh->history, config_, map_.labels, scan_, *fresh, unused);
    progress_();
  }
  archive_.note_integrated();
  MapDelta delta = new_delta();
  map_.content->octree.difference(fresh->octree, delta);
  map_.content = std::move(fresh);
  boxes_waiting_ = false;
  delta.revision = ++map_.revision;
  return delta;
}

Eigen::Vector3d SemanticMapper::up_in_map() const {
  if (config_.grid.up != "auto") return axis_of(config_.grid.up);
  if (saved_.up) return *saved_.up;
  const auto known = archive_.poses();
  std::vector<geometry::Pose> poses;
  for (const auto& pose : known) poses.push_back(pose.map_from_camera);
  return estimate_up(poses, [&](std::size_t i) { return archive_.record(known[i].id); });
}

}  // namespace rds::mapper
