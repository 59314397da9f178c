// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree/semantic_voxel.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace rds::mapper {
namespace {
constexpr std::uint16_t kMaxColorWeight = 32;  // later pictures still count: exposure drifts
}

void SemanticVoxel::see_color(const SurfaceVoxel& surface) {
  times_seen_ = std::min<std::uint16_t>(static_cast<std::uint16_t>(times_seen_ + 1), kMaxColorWeight);
  for (std::size_t c = 0; c < 3; ++c) {
    const float seen = static_cast<float>(surface.rgb_sum[c]) / static_cast<float>(surface.static_pixels);
    mean_rgb_[c] += (seen - mean_rgb_[c]) / static_cast<float>(times_seen_);
  }
}

void SemanticVoxel::vote(std::uint16_t label) {
  if (votes_cast_ == UINT16_MAX) return;
  ++votes_cast_;
  if (label == 0) return;
  auto mine = std::ranges::find_if(votes_, [&](const Votes& v) { return v.label == label; });
  if (mine == votes_.end()) mine = std::ranges::min_element(votes_, {}, &Votes::count);
  if (mine->label != label) {
    if (mine->count > 1) return;  // three better established labels
    *mine = {label, 0};
  }
  ++mine->count;
}

std::uint16_t SemanticVoxel::label(double needed_share) const {
  const auto better = [](const Votes& a, const Votes& b) {
    return a.count != b.count ? a.count < b.count : a.label > b.label;
  };
  const auto& best = *std::ranges::max_element(votes_, better);
  return best.count > 0 && best.count >= needed_share * votes_cast_ ? best.label : std::uint16_t{0};
}

Rgb SemanticVoxel::color() const {
  const auto channel = [&](std::size_t c) { return static_cast<std::uint8_t>(std::lround(mean_rgb_[c])); };
  return {channel(0), channel(1), channel(2)};
}

void SemanticVoxel::put(map_file::ByteWriter& writer) const {
  for (const float channel : mean_rgb_) writer.put(channel);
  writer.put(times_seen_);
  writer.put(votes_cast_);
  for (const Votes& votes : votes_) {
    writer.put(votes.label);
    writer.put(votes.count);
  }
}

SemanticVoxel SemanticVoxel::get(map_file::ByteReader& reader, std::size_t labels) {
  SemanticVoxel voxel;
  for (float& channel : voxel.mean_rgb_) {
    channel = reader.get<float>();
    if (channel < 0 || channel > 255) reader.refuse("a colour outside 0 … 255");
  }
  voxel.times_seen_ = reader.get<std::uint16_t>();
  voxel.votes_cast_ = reader.get<std::uint16_t>();
  for (Votes& votes : voxel.votes_) {
    votes.label = reader.get<std::uint16_t>();
    votes.count = reader.get<std::uint16_t>();
    if (votes.label >= labels) reader.refuse(fmt::format("label {} of {}", votes.label, labels));
  }
  return voxel;
}

}  // namespace rds::mapper
