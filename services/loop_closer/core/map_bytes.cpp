// SPDX-License-Identifier: Apache-2.0
// The keyframes as bytes and back.
#include "services/loop_closer/core/map_bytes.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "common/map_file/byte_reader.hpp"
#include "services/loop_closer/core/loop_closer.hpp"

namespace rds::loop_closer {
namespace {

using map_file::ByteReader;
using map_file::ByteWriter;

constexpr std::size_t kDescriptorBytes = 32;
constexpr std::size_t kFeatureBytes = kDescriptorBytes + 3 * sizeof(float);
constexpr std::size_t kKeyframeBytes = 2 * sizeof(std::uint64_t);

void put(ByteWriter& writer, const KeyframeView& view) {
  writer.put_count(view.points.size());
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    for (const double element : view.points[i]) writer.put(static_cast<float>(element));  // as they came
    writer.put_bytes({view.descriptors.ptr<std::uint8_t>(static_cast<int>(i)), kDescriptorBytes});
  }
}

KeyframeView get_view(ByteReader& reader) {
  KeyframeView view;
  const std::size_t features = reader.get_count(kFeatureBytes);
  view.points.resize(features);
  if (features > 0) view.descriptors.create(static_cast<int>(features), kDescriptorBytes, CV_8UC1);
  for (std::size_t i = 0; i < features; ++i) {
    for (double& element : view.points[i]) element = static_cast<double>(reader.get<float>());
    if (view.points[i].z() <= 0) reader.refuse("a point behind its camera");
    std::ranges::copy(reader.get_bytes(kDescriptorBytes),
                      view.descriptors.ptr<std::uint8_t>(static_cast<int>(i)));
  }
  return view;
}

struct SavedKeyframe {
  std::uint64_t id = 0;
  KeyframeView view;
};

tl::expected<std::vector<SavedKeyframe>, std::string> keyframes_from(std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  const std::size_t count = reader.get_count(kKeyframeBytes);
  std::vector<SavedKeyframe> keyframes;
  for (std::size_t i = 0; i < count && reader.ok(); ++i) {
    const auto id = reader.get<std::uint64_t>();
    keyframes.push_back({id, get_view(reader)});
  }
  if (const auto read = reader.finish(); !read) return tl::unexpected(read.error());
  return keyframes;
}

}  // namespace

tl::expected<map_file::Bytes, std::string> merge_maps(std::span<const std::uint8_t> earlier,
                                                      std::span<const std::uint8_t> later,
                                                      std::uint64_t first_of_later) {
  auto first = keyframes_from(earlier);
  if (!first) return tl::unexpected(first.error());
  const auto second = keyframes_from(later);
  if (!second) return tl::unexpected(second.error());
  std::erase_if(*first, [&](const SavedKeyframe& k) { return k.id >= first_of_later; });  // as start_from()
  ByteWriter writer;
  writer.put_count(first->size() + second->size());
  for (const SavedKeyframe& keyframe : *first) {
    writer.put(keyframe.id);
    put(writer, keyframe.view);
  }
  for (const SavedKeyframe& keyframe : *second) {
    writer.put(keyframe.id + first_of_later);
    put(writer, keyframe.view);
  }
  return writer.take();
}

/// @param keyframes  the first so many.
map_file::Bytes LoopCloser::to_bytes(std::size_t keyframes) const {
  ByteWriter writer;
  writer.put_count(keyframes);
  for (std::size_t i = 0; i < keyframes; ++i) {
    writer.put(graph_.id(i));
    put(writer, views_[i]);
  }
  return writer.take();
}

tl::expected<void, std::string> LoopCloser::start_from(std::span<const std::uint8_t> bytes,
                                                       std::span<const KeyframePose> poses) {
  ByteReader reader(bytes);
  Start start;
  const std::size_t keyframes = reader.get_count(kKeyframeBytes);
  for (std::size_t i = 0; i < keyframes && reader.ok(); ++i) {
    const auto id = reader.get<std::uint64_t>();
    auto view = get_view(reader);
    if (!poses.empty() && id > poses.back().id) continue;  // came after the poses had been saved
    start.views.push_back(std::move(view));
    const auto pose = std::ranges::lower_bound(poses, id, {}, &KeyframePose::id);
    if (pose == poses.end() || pose->id != id || (!start.poses.empty() && id <= start.poses.back().id))
      reader.refuse(fmt::format("keyframe {}, which has no pose or comes out of order", id));
    else
      start.poses.push_back(*pose);
  }
  if (auto read = reader.finish(); !read) return read;
  start_ = std::make_shared<const Start>(std::move(start));
  reset();
  return {};
}

}  // namespace rds::loop_closer
