// SPDX-License-Identifier: Apache-2.0
#include "common/image/recording.hpp"

#include <algorithm>
#include <utility>

#include "common/geometry/association.hpp"
#include "common/geometry/stamp.hpp"

namespace rds::image {

std::size_t Recording::without_depth() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(frames_, [](const FrameRef& frame) { return !frame.has_depth(); }));
}

std::string Recording::stamp_text(std::int64_t stamp_ns) const {
  const auto found = std::ranges::lower_bound(frames_, stamp_ns, {}, &FrameRef::stamp_ns);
  return found != frames_.end() && found->stamp_ns == stamp_ns ? found->stamp_text
                                                               : geometry::format_stamp(stamp_ns);
}

std::size_t Recording::pair_frames(std::vector<FrameRef> color, std::vector<std::int64_t> depth_stamps,
                                   std::int64_t tolerance_ns) {
  frames_ = std::move(color);
  depth_stamps_ = std::move(depth_stamps);
  std::vector<std::int64_t> stamps;
  stamps.reserve(frames_.size());
  for (FrameRef& frame : frames_) {
    frame.depth_stamp_ns = frame.stamp_ns;
    stamps.push_back(frame.stamp_ns);
  }
  const auto pairs = geometry::pair_in_order(stamps, depth_stamps_, tolerance_ns);
  for (const auto& [i, j] : pairs) {
    frames_[i].depth_stamp_ns = depth_stamps_[j];
    frames_[i].depth = j;
  }
  return pairs.size();
}

tl::expected<RgbdFrame, std::string> Recording::load(const FrameRef& frame) const {
  auto color = load_color(frame.index);
  if (!color) return tl::unexpected(color.error());
  tl::expected<DepthImage, std::string> depth = empty_depth({camera_.width, camera_.height});
  if (frame.depth) depth = load_depth(*frame.depth);
  if (!depth) return tl::unexpected(depth.error());
  return RgbdFrame{frame.stamp_ns, std::move(*color), std::move(*depth), camera_};
}

}  // namespace rds::image
