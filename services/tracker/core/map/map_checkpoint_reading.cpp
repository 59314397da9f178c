// SPDX-License-Identifier: Apache-2.0
// The part of map_checkpoint.hpp that reads.
#include <map>

#include <fmt/format.h>

#include "common/map_file/byte_reader.hpp"
#include "common/map_file/geometry_bytes.hpp"
#include "services/tracker/core/features/feature_bytes.hpp"
#include "services/tracker/core/map/map_bytes.hpp"
#include "services/tracker/core/map/map_checkpoint.hpp"

namespace rds::tracker {
namespace {

using map_file::ByteReader;

constexpr std::size_t kPointBytes = 8 + 24 + 8 + 8 + 16;

/// What a picture showed, by keyframe.
using Pictures = std::map<KeyframeId, Keyframe>;

Keyframe get_picture(ByteReader& reader, int levels) {
  Keyframe keyframe;
  const auto camera = map_file::get_camera(reader);
  for (double& v : keyframe.motion.velocity) v = reader.get<double>();
  keyframe.motion.readout_s = reader.get<double>();
  keyframe.given_fx = reader.get<double>();
  keyframe.pose_is_given = reader.get<std::uint8_t>() != 0;
  std::vector<Feature> features(reader.get_count(kFeatureBytes));
  bool movable_now = false;
  for (Feature& feature : features) feature = get_feature(reader, levels, movable_now);
  if (reader.ok()) keyframe.features = std::make_shared<const FeatureSet>(camera, std::move(features));
  return keyframe;
}

std::vector<bool> get_bits(ByteReader& reader, std::size_t expected) {
  std::vector<bool> bits(expected);
  if (reader.get<std::uint64_t>() != expected)
    reader.refuse("another number of features than the picture has");
  for (std::size_t i = 0; i < expected && reader.ok(); i += 8) {
    const unsigned byte = reader.get<std::uint8_t>();
    for (std::size_t b = 0; b < 8 && i + b < expected; ++b) bits[i + b] = ((byte >> b) & 1U) != 0;
  }
  return bits;
}

void get_keyframe(ByteReader& reader, const KeyframeRecord& record, Pictures& pictures,
                  MapContents& contents) {
  const auto picture = pictures.extract(record.id);
  if (!picture) return reader.refuse(fmt::format("keyframe {} without its features", record.id));
  Keyframe& keyframe = picture.mapped();
  keyframe.id = record.id;
  keyframe.stamp_ns = record.stamp_ns;
  keyframe.map_from_camera = map_file::get_pose(reader);
  keyframe.time_ns = reader.get<std::int64_t>();
  keyframe.tracked_points = reader.get<int>();
  keyframe.movable = get_bits(reader, keyframe.features->size());
  if (!reader.ok()) return;
  contents.keyframes.skip_to(record.id);
  contents.keyframes.emplace(std::move(keyframe));
}

bool has_more(const ByteReader& reader) {
  return reader.ok() && !reader.at_end();
}

void get_keyframes(ByteReader& reader, Pictures& pictures, MapContents& contents,
                   IdTable<KeyframeRecord>& records) {
  while (has_more(reader)) {
    KeyframeRecord record;
    record.id = reader.get<KeyframeId>();
    record.stamp_ns = reader.get<std::int64_t>();
    record.anchor = reader.get<KeyframeId>();
    record.pose_only = reader.get<std::uint8_t>() != 0;
    if (record.id < records.next_id() || record.id >= kMaxKeyframes)
      return reader.refuse(fmt::format("keyframe {} out of order", record.id));
    if (record.anchor == kNoId)
      get_keyframe(reader, record, pictures, contents);
    else
      record.anchor_from_camera = map_file::get_pose(reader);
    records.skip_to(record.id);
    records.emplace(record);
  }
}

MapPoint get_point(ByteReader& reader) {
  MapPoint point;
  point.id = reader.get<PointId>();
  point.position = map_file::get_vector(reader);
  point.created_by = reader.get<KeyframeId>();
  point.observations = get_observations(reader);
  return point;
}

void get_points(ByteReader& reader, MapContents& contents) {
  std::vector<MapPoint> points(reader.get_count(kPointBytes));
  for (MapPoint& point : points) point = get_point(reader);
  for (MapPoint& point : points) {
    point.visible = reader.get<std::uint32_t>();
    point.found = reader.get<std::uint32_t>();
    point.last_found_ns = reader.get<std::int64_t>();
    if (point.id < contents.points.next_id() || point.id >= kMaxPoints)
      reader.refuse(fmt::format("point {} out of order", point.id));
    if (!reader.ok()) return;
    contents.points.skip_to(point.id);
    contents.points.emplace(std::move(point));
  }
}

constexpr std::size_t kSubmapRowBytes = 8 + 4;

/// Ids: of the first keyframe that is not fixed, and of those that come next.
struct MapIds {
  KeyframeId first_free = 0;
  KeyframeId next_keyframe = 0;
  PointId next_point = 0;
  Submaps submaps;
};

MapIds get_ids(ByteReader& reader) {
  MapIds ids;
  for (std::uint64_t* id : {&ids.first_free, &ids.next_keyframe, &ids.next_point})
    *id = reader.get<std::uint64_t>();
  if (ids.next_keyframe >= kMaxKeyframes || ids.next_point >= kMaxPoints)
    reader.refuse("more keyframes than can be");
  const std::size_t rows = reader.get_count(kSubmapRowBytes);
  KeyframeId after = 0;
  for (std::size_t i = 0; i < rows && reader.ok(); ++i) {
    const auto first = reader.get<KeyframeId>();
    const auto submap = reader.get<SubmapId>();
    if (first < after || first >= ids.next_keyframe || submap >= kMaxKeyframes)
      reader.refuse("submaps out of order");
    else
      ids.submaps.go_on(submap, first);
    after = first + 1;
  }
  return ids;
}

}  // namespace

tl::expected<SlamMap, std::string> map_from_rows(const ReadRows& read, const ScalePyramid& pyramid) {
  MapContents contents;
  IdTable<KeyframeRecord> records;
  Pictures pictures;
  MapIds ids;
  std::string fault;
  const auto take = [&](const std::string& kind, const auto& get) {
    const auto done = read(kind, [&](std::uint64_t id, std::span<const std::uint8_t> bytes) {
      ByteReader reader(bytes);
      if (fault.empty()) get(id, reader);
      if (const auto whole = reader.finish(); fault.empty() && !whole) fault = whole.error();
    });
    if (fault.empty() && !done) fault = done.error();
  };
  take("features",
       [&](std::uint64_t id, ByteReader& reader) { pictures[id] = get_picture(reader, pyramid.levels()); });
  take("keyframes",
       [&](std::uint64_t, ByteReader& reader) { get_keyframes(reader, pictures, contents, records); });
  take("points", [&](std::uint64_t, ByteReader& reader) { get_points(reader, contents); });
  take("map", [&](std::uint64_t, ByteReader& reader) { ids = get_ids(reader); });
  if (!fault.empty()) return tl::unexpected(fault);
  contents.points.skip_to(ids.next_point);
  contents.records = KeyframeRecords(std::move(records), ids.first_free);
  contents.records.skip_ids(ids.next_keyframe);
  contents.records.submaps() = ids.submaps;
  return map_of(std::move(contents), pyramid);
}

}  // namespace rds::tracker
