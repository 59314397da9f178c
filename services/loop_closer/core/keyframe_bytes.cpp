// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/keyframe_bytes.hpp"

#include <algorithm>
#include <bit>

#include "common/map_file/geometry_bytes.hpp"

namespace rds::loop_closer {
namespace {

using map_file::ByteReader;
using map_file::ByteWriter;

constexpr int kDescriptorBytes = 32;
constexpr std::size_t kFeatureBytes = kDescriptorBytes + 3 * sizeof(float);
constexpr std::size_t kCovisibleBytes = 8 + 4 + 96;

/// Coordinates as their bits: a point without depth is not a number.
void put(ByteWriter& writer, const Eigen::Vector3f& point) {
  for (int axis = 0; axis < 3; ++axis) writer.put(std::bit_cast<std::uint32_t>(point[axis]));
}

Eigen::Vector3f get_point(ByteReader& reader) {
  Eigen::Vector3f point;
  for (int axis = 0; axis < 3; ++axis) point[axis] = std::bit_cast<float>(reader.get<std::uint32_t>());
  return point;
}

}  // namespace

map_file::Bytes to_bytes(const KeyframeFeatures& keyframe) {
  ByteWriter writer;
  writer.put(keyframe.map_epoch);
  writer.put(keyframe.id);
  writer.put(keyframe.stamp_ns);
  map_file::put(writer, keyframe.map_from_camera);
  writer.put(static_cast<std::uint8_t>(keyframe.follows));
  writer.put_count(keyframe.points.size());
  for (std::size_t i = 0; i < keyframe.points.size(); ++i) {
    writer.put_bytes({keyframe.descriptors.ptr<std::uint8_t>(static_cast<int>(i)), kDescriptorBytes});
    put(writer, keyframe.points[i]);
  }
  writer.put_count(keyframe.movable.size());
  writer.put_bytes(keyframe.movable);
  writer.put_count(keyframe.covisible.size());
  for (const Covisible& other : keyframe.covisible) {
    writer.put(other.id);
    writer.put(other.weight);
    map_file::put(writer, other.map_from_camera);
  }
  return writer.take();
}

tl::expected<KeyframeFeatures, std::string> keyframe_from_bytes(std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  KeyframeFeatures keyframe;
  keyframe.map_epoch = reader.get<std::uint64_t>();
  keyframe.id = reader.get<std::uint64_t>();
  keyframe.stamp_ns = reader.get<std::int64_t>();
  keyframe.map_from_camera = map_file::get_pose(reader);
  keyframe.follows = reader.get<std::uint8_t>() != 0;
  const std::size_t features = reader.get_count(kFeatureBytes);
  keyframe.descriptors.create(static_cast<int>(features), kDescriptorBytes, CV_8U);
  keyframe.points.resize(features);
  for (std::size_t i = 0; i < features && reader.ok(); ++i) {
    std::ranges::copy(reader.get_bytes(kDescriptorBytes),
                      keyframe.descriptors.ptr<std::uint8_t>(static_cast<int>(i)));
    keyframe.points[i] = get_point(reader);
  }
  const auto movable = reader.get_bytes(reader.get_count(1));
  keyframe.movable.assign(movable.begin(), movable.end());
  keyframe.covisible.resize(reader.get_count(kCovisibleBytes));
  for (Covisible& other : keyframe.covisible) {
    other.id = reader.get<std::uint64_t>();
    other.weight = reader.get<std::uint32_t>();
    other.map_from_camera = map_file::get_pose(reader);
  }
  if (auto read = reader.finish(); !read) return tl::unexpected(read.error());
  return keyframe;
}

}  // namespace rds::loop_closer
