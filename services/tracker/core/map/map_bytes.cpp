// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/map_bytes.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "common/map_file/geometry_bytes.hpp"
#include "services/tracker/core/features/feature_bytes.hpp"

namespace rds::tracker {
namespace {

using map_file::ByteReader;
using map_file::ByteWriter;

constexpr std::size_t kKeyframeBytes = 8 + 88 + 8;
constexpr std::size_t kPointBytes = 24 + 8;

void put(ByteWriter& writer, const Keyframe& keyframe) {
  writer.put(keyframe.id);
  map_file::put(writer, keyframe.features->camera());
  writer.put_count(keyframe.features->size());
  for (std::size_t i = 0; i < keyframe.features->size(); ++i)
    tracker::put(writer, (*keyframe.features)[i], keyframe.movable[i]);
}

/// By ascending id, none twice, and none that so many keyframes cannot have been made for.
bool are_in_order(std::span<const KeyframePose> poses) {
  const auto not_less = std::ranges::adjacent_find(poses, std::ranges::greater_equal{}, &KeyframePose::id);
  return not_less == poses.end() && (poses.empty() || poses.back().id < kMaxKeyframes);
}

/// Takes the poses of culled keyframes below this id from the front of the list.
void add_saved(std::span<const KeyframePose>& poses, KeyframeId end, MapContents& contents) {
  for (; !poses.empty() && poses.front().id < end; poses = poses.subspan(1)) {
    contents.records.skip_ids(poses.front().id);
    const Pose& pose = poses.front().map_from_camera;
    contents.records.add_saved(poses.front().stamp_ns, 0,
                               contents.keyframes.find(0)->map_from_camera.inverse() * pose, pose);
  }
  contents.records.skip_ids(end);
}

/// @param poses  by id; those up to this keyframe's are taken from the front.
void get_keyframe(ByteReader& reader, std::span<const KeyframePose>& poses, int levels,
                  MapContents& contents) {
  const auto id = reader.get<KeyframeId>();
  const auto camera = map_file::get_camera(reader);
  std::vector<Feature> features(reader.get_count(kFeatureBytes));
  std::vector<bool> movable(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    bool movable_now = false;
    features[i] = get_feature(reader, levels, movable_now);
    movable[i] = movable_now;
  }
  const bool is_known = std::ranges::binary_search(poses, id, {}, &KeyframePose::id);
  const KeyframeId next = contents.records.next_id();
  const bool in_order = is_known && id >= next && (id == 0 || contents.records.contains(0));
  if (!in_order) reader.refuse(fmt::format("keyframe {} where {} was expected", id, next));
  if (!reader.ok()) return;
  add_saved(poses, id, contents);
  Keyframe keyframe;
  keyframe.id = contents.records.add(poses.front().stamp_ns);
  keyframe.stamp_ns = keyframe.time_ns = poses.front().stamp_ns;
  keyframe.map_from_camera = poses.front().map_from_camera;
  keyframe.features = std::make_shared<const FeatureSet>(camera, std::move(features));
  keyframe.movable = std::move(movable);
  contents.keyframes.skip_to(id);
  contents.keyframes.emplace(std::move(keyframe));
  poses = poses.subspan(1);
}

void get_point(ByteReader& reader, MapContents& contents) {
  MapPoint point;
  point.id = contents.points.next_id();
  point.position = map_file::get_vector(reader);
  point.observations = get_observations(reader);
  if (!point.observations.empty()) point.created_by = point.observations.front().keyframe;
  contents.points.emplace(std::move(point));
}

}  // namespace

void put(ByteWriter& writer, const std::vector<Observation>& observations) {
  writer.put_count(observations.size());
  for (const Observation& o : observations) {
    writer.put(o.keyframe);
    writer.put(o.feature);
  }
}

std::vector<Observation> get_observations(ByteReader& reader) {
  constexpr std::size_t kObservationBytes = 8 + 4;
  std::vector<Observation> observations(reader.get_count(kObservationBytes));
  for (Observation& o : observations) {
    o.keyframe = reader.get<KeyframeId>();
    o.feature = reader.get<std::uint32_t>();
  }
  return observations;
}

map_file::Bytes to_bytes(const SlamMap& map, const KnownCamera& camera, const ExtractionConfig& extraction) {
  ByteWriter writer;
  put_pyramid(writer, extraction);
  writer.put(camera.given_fx);
  writer.put(camera.focal_scale);
  std::vector<const Keyframe*> keyframes;
  map.keyframes().for_each([&](const Keyframe& k) {
    if (map.records().is_placed(k.id)) keyframes.push_back(&k);
  });
  writer.put_count(keyframes.size());
  for (const Keyframe* keyframe : keyframes) put(writer, *keyframe);
  std::vector<const MapPoint*> points;
  map.points().for_each([&](const MapPoint& p) {
    if (map.records().is_placed(p.observations.front().keyframe)) points.push_back(&p);
  });
  writer.put_count(points.size());
  for (const MapPoint* point : points) {
    map_file::put(writer, point->position);
    put(writer, point->observations);
  }
  return writer.take();
}

tl::expected<ExtractionConfig, std::string> pyramid_of(std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  const ExtractionConfig extraction = get_pyramid(reader);
  if (!reader.ok()) return tl::unexpected(reader.finish().error());
  return extraction;
}

tl::expected<SavedMap, std::string> map_from_bytes(std::span<const std::uint8_t> bytes,
                                                   std::span<const KeyframePose> poses,
                                                   const ExtractionConfig& extraction) {
  ByteReader reader(bytes);
  expect_pyramid(reader, extraction);
  KnownCamera camera;
  camera.given_fx = reader.get<double>();
  camera.focal_scale = reader.get<double>();
  MapContents contents;
  if (!are_in_order(poses)) reader.refuse("keyframe poses out of order");
  const std::size_t keyframes = reader.get_count(kKeyframeBytes);
  for (std::size_t i = 0; i < keyframes && reader.ok(); ++i)
    get_keyframe(reader, poses, extraction.levels, contents);
  if (contents.keyframes.size() > 0 && !poses.empty())
    add_saved(poses, poses.back().id + 1, contents);
  else if (!poses.empty())
    reader.refuse("poses of keyframes that are not there");
  const std::size_t points = reader.get_count(kPointBytes);
  for (std::size_t i = 0; i < points && reader.ok(); ++i) get_point(reader, contents);
  if (const auto read = reader.finish(); !read) return tl::unexpected(read.error());
  contents.records.fix_all();
  auto map = map_of(std::move(contents), ScalePyramid(extraction.levels, extraction.scale_factor));
  if (!map) return tl::unexpected(map.error());
  return SavedMap{std::move(*map), camera};
}

}  // namespace rds::tracker
