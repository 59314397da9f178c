// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/map_bytes.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "common/map_file/byte_reader.hpp"
#include "common/map_file/geometry_bytes.hpp"
#include "services/tracker/core/features/feature_bytes.hpp"

namespace rds::tracker {
namespace {

using map_file::ByteReader;
using map_file::ByteWriter;

constexpr std::size_t kKeyframeBytes = 8 + 88 + 8;
constexpr std::size_t kPointBytes = 24 + 8;
constexpr std::size_t kObservationBytes = 8 + 4;

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
void add_culled(std::span<const KeyframePose>& poses, KeyframeId end, SlamMap& map) {
  for (; !poses.empty() && poses.front().id < end; poses = poses.subspan(1)) {
    map.skip_keyframe_ids(poses.front().id);
    map.add_pose_only(poses.front().stamp_ns, poses.front().map_from_camera, 0);
  }
  map.skip_keyframe_ids(end);
}

/// @param poses  by id; those up to this keyframe's are taken from the front.
void get_keyframe(ByteReader& reader, std::span<const KeyframePose>& poses, int levels, SlamMap& map) {
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
  const bool in_order = is_known && id >= map.next_keyframe_id() && (id == 0 || map.knows(0));
  if (!in_order) reader.refuse(fmt::format("keyframe {} where {} was expected", id, map.next_keyframe_id()));
  if (!reader.ok()) return;
  add_culled(poses, id, map);
  Keyframe& keyframe = map.add_keyframe(poses.front().stamp_ns, poses.front().map_from_camera,
                                        std::make_shared<const FeatureSet>(camera, std::move(features)));
  poses = poses.subspan(1);
  keyframe.movable = std::move(movable);
}

void put(ByteWriter& writer, const MapPoint& point) {
  map_file::put(writer, point.position);
  writer.put_count(point.observations.size());
  for (const Observation& observation : point.observations) {
    writer.put(observation.keyframe);
    writer.put(observation.feature);
  }
}

void get_point(ByteReader& reader, SlamMap& map) {
  const Eigen::Vector3d position = map_file::get_vector(reader);
  const std::size_t observations = reader.get_count(kObservationBytes);
  if (observations == 0) reader.refuse("a map point that no keyframe sees");
  MapPoint* point = nullptr;
  for (std::size_t i = 0; i < observations && reader.ok(); ++i) {
    const auto keyframe = reader.get<KeyframeId>();
    const auto feature = reader.get<std::uint32_t>();
    if (map.keyframe(keyframe) == nullptr) {
      reader.refuse(fmt::format("a map point in keyframe {}, which is not there", keyframe));
    } else if (point == nullptr) {
      point = &map.add_point(position, keyframe, feature);
      if (point->observations.empty()) reader.refuse("a map point at a feature that cannot have one");
    } else if (!map.observe(point->id, keyframe, feature)) {
      reader.refuse("a map point at a feature that cannot have one");
    }
  }
  if (reader.ok()) map.refresh(*point);
}

}  // namespace

map_file::Bytes to_bytes(const SlamMap& map, const KnownCamera& camera, const ExtractionConfig& extraction) {
  ByteWriter writer;
  put_pyramid(writer, extraction);
  writer.put(camera.given_fx);
  writer.put(camera.focal_scale);
  writer.put_count(map.keyframes());
  map.all_keyframes().for_each([&](const Keyframe& keyframe) { put(writer, keyframe); });
  writer.put_count(map.points());
  map.all_points().for_each([&](const MapPoint& point) { put(writer, point); });
  return writer.take();
}

tl::expected<SavedMap, std::string> map_from_bytes(std::span<const std::uint8_t> bytes,
                                                   std::span<const KeyframePose> poses,
                                                   const MapConfig& config,
                                                   const ExtractionConfig& extraction) {
  ByteReader reader(bytes);
  expect_pyramid(reader, extraction);
  KnownCamera camera;
  camera.given_fx = reader.get<double>();
  camera.focal_scale = reader.get<double>();
  SlamMap map(config, ScalePyramid(extraction.levels, extraction.scale_factor));
  if (!are_in_order(poses)) reader.refuse("keyframe poses out of order");
  const std::size_t keyframes = reader.get_count(kKeyframeBytes);
  for (std::size_t i = 0; i < keyframes && reader.ok(); ++i)
    get_keyframe(reader, poses, extraction.levels, map);
  if (map.keyframes() > 0 && !poses.empty())
    add_culled(poses, poses.back().id + 1, map);
  else if (!poses.empty())
    reader.refuse("poses of keyframes that are not there");
  const std::size_t points = reader.get_count(kPointBytes);
  for (std::size_t i = 0; i < points && reader.ok(); ++i) get_point(reader, map);
  if (const auto read = reader.finish(); !read) return tl::unexpected(read.error());
  map.update_all_covisibility();
  map.fix_keyframes();
  return SavedMap{std::move(map), camera};
}

}  // namespace rds::tracker
