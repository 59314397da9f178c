// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/semantic_mapper.hpp"

#include <algorithm>
#include <stdexcept>

#include "services/mapper/core/segmentation/gravity.hpp"

namespace rds::mapper {

SemanticMapper::SemanticMapper(MapperConfig config, std::uint64_t map_epoch,
                               std::unique_ptr<SpillStorage> storage, std::pmr::memory_resource* memory)
    : config_(std::move(config)),
      memory_(memory),
      map_(config_, map_epoch, memory),
      archive_(config_, std::move(storage)),
      final_objects_(config_.objects) {}

void SemanticMapper::reset(std::uint64_t map_epoch) {
  archive_.clear();
  object_views_.clear();
  map_.epoch = map_epoch;
  map_.labels = saved_.labels;
  map_.content = std::make_unique<Map>(config_, memory_);
  map_.content->objects = final_objects_ = saved_.objects.value_or(ObjectDatabase(config_.objects));
  are_objects_outdated_ = has_moves_left_ = false;
  has_final_ = saved_.voxels != nullptr;
  if (has_final_) map_.content->evidence.begin_with(*saved_.voxels);
  show();
  map_.revision = has_final_ ? 1 : 0;
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

/// What a change of the evidence changes in the map. @param all  whether no decision may be left as it was.
MapDelta SemanticMapper::show(bool all) {
  MapDelta delta = new_delta();
  Map& map = *map_.content;
  const auto show_block = [&](const octomap::OcTreeKey& key, const EvidenceBlock& block,
                              const BlockMask& changed) {
    map.octree.show(key, block, changed, map_.labels, delta);
  };
  if (all)
    map.evidence.update_all(show_block);
  else
    map.evidence.update(show_block);
  if (are_objects_outdated_ && !has_moves_left_) make_objects_again(true);
  is_hidden_ = false;
  delta.revision = ++map_.revision;
  return delta;
}

MapDelta SemanticMapper::integrate(const KeyframeInput& input) {
  if (const auto fault = check(input)) throw std::invalid_argument(*fault);
  if (archive_.keyframes().contains(input.id))
    throw std::invalid_argument(fmt::format("keyframe {}: is in the map already", input.id));
  auto record = make_record(input, config_.sampling, archive_.rays_of(input.camera));
  interpret(record, input.boxes, config_, map_.labels);
  archive_.add(record);
  add(record);
  MapDelta delta = show();
  delta.keyframe_id = input.id;
  delta.stamp_ns = input.stamp_ns;
  spill();
  return delta;
}

/// Adds what a keyframe says with the pose and time it has.
void SemanticMapper::add(const KeyframeRecord& record) {
  map_.content->evidence.add(record.id, record.time_ns,
                             contribution_of(record, config_.octree, config_.sampling, scan_));
  const auto view = object_views_.insert_or_assign(record.id, ObjectView::of(record)).first;
  if (std::next(view) == object_views_.end() && (!are_objects_outdated_ || has_moves_left_))
    map_.content->objects.integrate(view->second, map_.labels);
  else
    are_objects_outdated_ = true;
  archive_.note_integrated(record.id);
  is_hidden_ = true;
}

/// Takes out what a keyframe says.
void SemanticMapper::remove(std::uint64_t id) {
  map_.content->evidence.remove(id);
  are_objects_outdated_ = true;
  is_hidden_ = true;
}

/// Takes keyframes out of the evidence and puts them in again with their newest poses.
void SemanticMapper::move(std::span<const std::uint64_t> keyframes) {
  for (const std::uint64_t id : keyframes) {
    progress_();
    const auto record = archive_.record(id);
    if (!record) {
      lose(id);
      continue;
    }
    remove(id);
    add(*record);
  }
}

/// Objects are few, so that all views are seen again. They keep their ids, unless these are to be a function of
/// the views, too, whatever came before.
void SemanticMapper::make_objects_again(bool keep_ids) {
  ObjectDatabase objects = final_objects_;
  if (keep_ids) objects.reserve_ids_of(map_.content->objects);
  for (const auto& [id, view] : object_views_) objects.integrate(view, map_.labels);
  if (keep_ids) objects.take_ids_from(map_.content->objects);
  map_.content->objects = std::move(objects);
  are_objects_outdated_ = false;
}

/// Its part of the map stays as it is, whatever corrections come.
void SemanticMapper::make_final(std::uint64_t id) {
  map_.content->evidence.make_final(id);
  are_objects_outdated_ |= id != object_views_.begin()->first;
  final_objects_.reserve_ids_of(map_.content->objects);
  final_objects_.integrate(object_views_.at(id), map_.labels);
  final_objects_.take_ids_from(map_.content->objects);
  map_.content->objects.reserve_ids_of(final_objects_);
  object_views_.erase(id);
  has_final_ = true;
  archive_.make_final(id);
}

/// A keyframe whose record cannot be had any more leaves the map.
void SemanticMapper::lose(std::uint64_t id) {
  remove(id);
  object_views_.erase(id);
  archive_.lose(id);
}

void SemanticMapper::spill() {
  while (const auto id = archive_.spill()) make_final(*id);
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
    lose(keyframe_id);
    return false;
  }
  remove(keyframe_id);
  interpret(*record, boxes, config_, map_.labels);
  archive_.replace(*record);
  add(*record);
  spill();
  return true;
}

MapDelta SemanticMapper::apply_poses(std::span<const KeyframePose> poses) {
  archive_.set_poses(poses);
  return go_on_correcting();
}

MapDelta SemanticMapper::go_on_correcting() {
  const auto moved = nearest_first(archive_.moved_enough());
  const std::size_t now = std::min(moved.size(), kMovedAtOnce);
  move(std::span(moved).first(now));
  has_moves_left_ = moved.size() > now;
  return is_hidden_ || is_correcting() || are_objects_outdated_ ? show() : new_delta();
}

/// By the distance of cameras from the newest one, of equal ones the newest first.
std::vector<std::uint64_t> SemanticMapper::nearest_first(std::vector<std::uint64_t> keyframes) const {
  if (keyframes.empty()) return keyframes;
  const auto& all = archive_.keyframes();
  const Eigen::Vector3d here = all.rbegin()->second.pose.translation();
  std::vector<std::pair<double, std::uint64_t>> ranked;
  for (const std::uint64_t id : keyframes)
    ranked.emplace_back((all.at(id).pose.translation() - here).squaredNorm(), ~id);
  std::ranges::sort(ranked);
  std::ranges::transform(ranked, keyframes.begin(), [](const auto& rank) { return ~rank.second; });
  return keyframes;
}

MapDelta SemanticMapper::settle(std::span<const KeyframePose> poses) {
  archive_.set_poses(poses);
  archive_.set_times();
  move(archive_.moved());
  has_moves_left_ = false;
  make_objects_again(false);
  return show(true);
}

Eigen::Vector3d SemanticMapper::up_in_map() const {
  const bool from_surfaces = config_.grid.up == "surfaces";
  if (!from_surfaces && config_.grid.up != "auto") return axis_of(config_.grid.up);
  if (saved_.up) return *saved_.up;
  if (!from_surfaces) return Eigen::Vector3d::UnitZ();
  const auto known = archive_.poses();
  std::vector<geometry::Pose> poses;
  for (const auto& pose : known) poses.push_back(pose.map_from_camera);
  return estimate_up(poses, [&](std::size_t i) { return archive_.record(known[i].id); });
}

}  // namespace rds::mapper
