// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/keyframe/keyframe_archive.hpp"

#include <algorithm>

#include "common/map_file/geometry_bytes.hpp"

namespace rds::mapper {
namespace {

constexpr double kMinMoveM = 0.01;  // a fifth of a voxel; smaller corrections wait for settle()
constexpr double kMinTurnRad = 0.5 * (3.14159265358979 / 180);  // 3.5 cm at 4 m
constexpr double kBytesPerMb = 1e6;
constexpr std::size_t kMaxUnsavedFinal = 100;  // then the final map, which is large, is saved again
constexpr std::uint64_t kIdsPerBlock = 64;
constexpr std::size_t kKeyframeBytes = 8 + 8 + 96;

bool has_labels_below(const KeyframeRecord& record, std::size_t labels) {
  const auto is_below = [&](std::uint16_t label) { return label < labels; };
  return std::ranges::all_of(record.objects.labels, is_below) &&
         std::ranges::all_of(record.objects.sightings, is_below, &ObjectSighting::label);
}

}  // namespace

KeyframeArchive::KeyframeArchive(const MapperConfig& config, std::unique_ptr<SpillStorage> storage)
    : config_(config), rays_(config.sampling), records_(std::move(storage)) {}

void KeyframeArchive::clear() {
  records_.clear();
  keyframes_.clear();
  clock_ = final_clock_ = {};
  final_keyframes_ = 0;
  unsaved_final_.clear();
  has_checkpoint_ = false;
}

std::vector<KeyframePose> KeyframeArchive::poses() const {
  std::vector<KeyframePose> poses;
  for (const auto& [id, keyframe] : keyframes_) poses.push_back({id, keyframe.stamp_ns, keyframe.pose});
  return poses;
}

/// Times follow the order of the ids, whatever the order of arrival.
void KeyframeArchive::add(KeyframeRecord& record) {
  const auto next = keyframes_.upper_bound(record.id);
  record.time_ns = next == keyframes_.end()
                       ? clock_.go_to(record.stamp_ns).time_ns
                       : next->second.time_ns - (next->second.stamp_ns - record.stamp_ns);
  keyframes_[record.id] = {record.stamp_ns, record.time_ns, record.map_from_camera, record.map_from_camera,
                           record.time_ns};
  records_.put(record);
}

std::optional<KeyframeRecord> KeyframeArchive::record(std::uint64_t id) const {
  auto record = records_.get(id);
  if (!record) return record;
  record->grid.rays = rays_.of(record->grid.camera);
  record->map_from_camera = keyframes_.at(id).pose;
  record->time_ns = keyframes_.at(id).time_ns;
  return record;
}

std::optional<std::uint64_t> KeyframeArchive::spill() {
  const double limit = config_.correction.memory_mb * kBytesPerMb;
  while (static_cast<double>(records_.bytes_in_memory()) > limit && records_.in_memory() > 1) {
    if (records_.spill_oldest()) continue;
    ++lost_;
    return records_.oldest_in_memory();
  }
  const bool too_many = keyframes_.size() > static_cast<std::size_t>(config_.correction.max_keyframes);
  return too_many ? std::optional(keyframes_.begin()->first) : std::nullopt;
}

void KeyframeArchive::make_final(std::uint64_t id) {
  const bool is_oldest = id == keyframes_.begin()->first;
  const auto keyframe = keyframes_.extract(id);
  if (is_oldest) final_clock_.go_to(keyframe.mapped().stamp_ns);
  has_checkpoint_ = has_checkpoint_ && records_.retire(id);
  if (has_checkpoint_)
    unsaved_final_[id] = keyframe.mapped();  // until a checkpoint has the final map with it
  else
    records_.erase(id);
  ++final_keyframes_;
}

void KeyframeArchive::lose(std::uint64_t id) {
  keyframes_.erase(id);
  records_.erase(id);
  ++final_keyframes_;
  ++lost_;
}

void KeyframeArchive::set_poses(std::span<const KeyframePose> poses) {
  for (const auto& pose : poses) {
    const auto found = keyframes_.find(pose.id);
    if (found != keyframes_.end() && geometry::is_finite(pose.map_from_camera))
      found->second.pose = pose.map_from_camera;
  }
}

std::vector<std::uint64_t> KeyframeArchive::moved() const {
  std::vector<std::uint64_t> ids;
  for (const auto& [id, keyframe] : keyframes_)
    if (keyframe.pose.matrix() != keyframe.integrated_pose.matrix() ||
        keyframe.time_ns != keyframe.integrated_time_ns)
      ids.push_back(id);
  return ids;
}

std::vector<std::uint64_t> KeyframeArchive::moved_enough() const {
  std::vector<std::uint64_t> ids;
  for (const auto& [id, keyframe] : keyframes_) {
    const geometry::Pose moved = keyframe.integrated_pose.inverse() * keyframe.pose;
    if (moved.translation().norm() > kMinMoveM || geometry::rotation_angle_rad(moved.linear()) > kMinTurnRad)
      ids.push_back(id);
  }
  return ids;
}

void KeyframeArchive::set_times() {
  clock_ = final_clock_;
  for (auto& [id, keyframe] : keyframes_) keyframe.time_ns = clock_.go_to(keyframe.stamp_ns).time_ns;
}

void KeyframeArchive::note_integrated(std::uint64_t id) {
  Keyframe& keyframe = keyframes_.at(id);
  keyframe.integrated_pose = keyframe.pose;
  keyframe.integrated_time_ns = keyframe.time_ns;
}

std::optional<ArchiveCheckpoint> KeyframeArchive::save(bool has_final_map) {
  if (!records_.save()) return std::nullopt;
  ArchiveCheckpoint checkpoint;
  checkpoint.needs_final_map =
      (!has_checkpoint_ && has_final_map) || unsaved_final_.size() >= kMaxUnsavedFinal;
  if (checkpoint.needs_final_map) {
    for (const auto& [id, keyframe] : unsaved_final_) records_.erase_retired(id);
    unsaved_final_.clear();
  }
  has_checkpoint_ = true;
  checkpoint.saved_final = final_keyframes_ - unsaved_final_.size();
  std::map<std::uint64_t, map_file::ByteWriter> writers;
  for (const auto* keyframes : {&unsaved_final_, &keyframes_})
    for (const auto& [id, keyframe] : *keyframes) {
      map_file::ByteWriter& block = writers[id / kIdsPerBlock];
      block.put(id);
      block.put(keyframe.stamp_ns);
      map_file::put(block, keyframe.pose);
    }
  for (auto& [block, writer] : writers) checkpoint.keyframes[block] = writer.take();
  return checkpoint;
}

tl::expected<std::map<std::uint64_t, Keyframe>, std::string> KeyframeArchive::from_blocks(
    const KeyframeBlocks& blocks) {
  std::map<std::uint64_t, Keyframe> keyframes;
  for (const auto& [block, bytes] : blocks) {
    map_file::ByteReader reader(bytes);
    for (std::size_t i = 0; i < bytes.size() / kKeyframeBytes; ++i) {
      const auto id = reader.get<std::uint64_t>();
      const auto stamp_ns = reader.get<std::int64_t>();
      const auto pose = map_file::get_pose(reader);
      keyframes[id] = {stamp_ns, stamp_ns, pose, pose, stamp_ns};  // times follow with set_times()
    }
    if (auto read = reader.finish(); !read) return tl::unexpected(read.error());
  }
  return keyframes;
}

void KeyframeArchive::restore(std::map<std::uint64_t, Keyframe> keyframes, std::size_t final_keyframes,
                              std::size_t labels) {
  final_keyframes_ = final_keyframes;
  keyframes_ = std::move(keyframes);
  has_checkpoint_ = true;
  std::vector<std::uint64_t> lost;
  const double limit = config_.correction.memory_mb * kBytesPerMb;
  for (const auto& [id, keyframe] : keyframes_) {
    const auto record = records_.adopt(id);
    if (!record || !has_labels_below(*record, labels)) lost.push_back(id);
    while (static_cast<double>(records_.bytes_in_memory()) > limit && records_.in_memory() > 1)
      if (!records_.spill_oldest()) break;
  }
  for (const auto id : lost) lose(id);
}

}  // namespace rds::mapper
