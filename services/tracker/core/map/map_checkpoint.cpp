// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/map_checkpoint.hpp"

#include <utility>

#include "common/map_file/checksum.hpp"
#include "common/map_file/geometry_bytes.hpp"
#include "services/tracker/core/features/feature_bytes.hpp"
#include "services/tracker/core/map/map_bytes.hpp"

namespace rds::tracker {
namespace {

using map_file::Bytes;
using map_file::ByteWriter;

constexpr const char* kFeatures = "features";
constexpr const char* kKeyframes = "keyframes";
constexpr const char* kPoints = "points";
constexpr const char* kMap = "map";
// Ids that are left out after a restart: more than are given between two checkpoints, even while the disk is
// full.
constexpr KeyframeId kReservedKeyframes = 10'000;
constexpr PointId kReservedPoints = 10'000'000;

Bytes features_of(const Keyframe& keyframe) {
  ByteWriter writer;
  map_file::put(writer, keyframe.features->camera());
  for (const double v : keyframe.motion.velocity) writer.put(v);
  writer.put(keyframe.motion.readout_s);
  writer.put(keyframe.given_fx);
  writer.put(static_cast<std::uint8_t>(keyframe.pose_is_given));
  writer.put_count(keyframe.features->size());
  for (const Feature& feature : keyframe.features->all()) put(writer, feature, feature.movable);
  return writer.take();
}

void put_bits(ByteWriter& writer, const std::vector<bool>& bits) {
  writer.put_count(bits.size());
  for (std::size_t i = 0; i < bits.size(); i += 8) {
    unsigned byte = 0;
    for (std::size_t b = 0; b < 8 && i + b < bits.size(); ++b) byte |= (bits[i + b] ? 1U : 0U) << b;
    writer.put(static_cast<std::uint8_t>(byte));
  }
}

void put(ByteWriter& writer, const Keyframe& keyframe) {
  map_file::put(writer, keyframe.map_from_camera);
  writer.put(keyframe.time_ns);
  writer.put(keyframe.tracked_points);
  put_bits(writer, keyframe.movable);
}

std::optional<Bytes> keyframes_of(const SlamMap& map, std::size_t block) {
  ByteWriter writer;
  map.records().all().for_each_in(block, [&](const KeyframeRecord& record) {
    writer.put(record.id);
    writer.put(record.stamp_ns);
    writer.put(record.anchor);
    writer.put(static_cast<std::uint8_t>(record.pose_only));
    if (record.anchor == kNoId)
      put(writer, *map.keyframe(record.id));
    else
      map_file::put(writer, record.anchor_from_camera);
  });
  return writer.bytes().empty() ? std::nullopt : std::optional(writer.take());
}

void put(ByteWriter& writer, const MapPoint& point) {
  writer.put(point.id);
  map_file::put(writer, point.position);
  writer.put(point.created_by);
  put(writer, point.observations);
}

/// What lasts of the points of a block.
ByteWriter points_of(const SlamMap& map, std::size_t block) {
  std::size_t count = 0;
  map.points().for_each_in(block, [&](const MapPoint&) { ++count; });
  ByteWriter writer;
  writer.put_count(count);
  map.points().for_each_in(block, [&](const MapPoint& point) { put(writer, point); });
  return writer;
}

/// What changes with every frame.
void put_counters(ByteWriter& writer, const SlamMap& map, std::size_t block) {
  map.points().for_each_in(block, [&](const MapPoint& point) {
    writer.put(point.visible);
    writer.put(point.found);
    writer.put(point.last_found_ns);
  });
}

Bytes common_to_all(const SlamMap& map) {
  ByteWriter writer;
  writer.put(map.records().first_free());
  writer.put(map.records().next_id() + kReservedKeyframes);
  writer.put(map.points().next_id() + kReservedPoints);
  const auto& rows = map.records().submaps().rows();
  writer.put_count(rows.size());
  for (const auto& [keyframe, submap] : rows) {
    writer.put(keyframe);
    writer.put(submap);
  }
  return writer.take();
}

}  // namespace

void MapCheckpoint::mark_written(SlamMap& map) {
  map.keyframes().take_touched();
  map.records().all().take_touched();
  for (const std::size_t block : map.points().take_touched())
    points_[block] = map_file::checksum_of(points_of(map, block).bytes());
  std::as_const(map).keyframes().for_each([this](const Keyframe& k) { with_features_.insert(k.id); });
}

void MapCheckpoint::append_features(const SlamMap& map, std::size_t block, std::vector<CheckpointRow>& rows) {
  constexpr std::size_t kBlock = IdTable<Keyframe>::kBlock;
  const auto end = with_features_.lower_bound((block + 1) * kBlock);
  for (auto written = with_features_.lower_bound(block * kBlock); written != end;) {
    const bool is_there = map.keyframe(*written) != nullptr;
    if (!is_there) rows.push_back({kFeatures, *written, std::nullopt});
    written = is_there ? std::next(written) : with_features_.erase(written);
  }
  map.keyframes().for_each_in(block, [&](const Keyframe& keyframe) {
    if (with_features_.insert(keyframe.id).second)
      rows.push_back({kFeatures, keyframe.id, features_of(keyframe)});
  });
}

void MapCheckpoint::append_points(const SlamMap& map, std::size_t block, std::vector<CheckpointRow>& rows) {
  ByteWriter points = points_of(map, block);
  const std::uint64_t checksum = map_file::checksum_of(points.bytes());
  const auto [written, is_new] = points_.try_emplace(block, checksum);
  if (!is_new && std::exchange(written->second, checksum) == checksum) return;
  put_counters(points, map, block);
  rows.push_back({kPoints, block, points.take()});
}

void MapCheckpoint::append_changes(SlamMap& map, std::vector<CheckpointRow>& rows) {
  const SlamMap& seen = map;
  std::set<std::size_t> keyframes;
  for (const std::size_t block : map.keyframes().take_touched()) keyframes.insert(block);
  for (const std::size_t block : map.records().all().take_touched()) keyframes.insert(block);
  for (const std::size_t block : keyframes) {
    append_features(seen, block, rows);
    rows.push_back({kKeyframes, block, keyframes_of(seen, block)});
  }
  for (const std::size_t block : map.points().take_touched()) append_points(seen, block, rows);
  rows.push_back({kMap, 0, common_to_all(seen)});
}

}  // namespace rds::tracker
