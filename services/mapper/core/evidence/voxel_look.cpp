// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/voxel_look.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace rds::mapper {
namespace {

constexpr int kLabelParts = 4;  // one of so many votes: of an object most views show a part
// A detector finds furniture in few of the views that show it: a vote outweighs so many keyframes that found
// nothing. As ObjectDatabase has it: .85 for a sighting, .05 for none.
constexpr int kSilentPerVote = 17;
constexpr std::int32_t kMostKeyframes = 8'000'000;  // 255 times so many still fits

}  // namespace

void VoxelLook::count(const SurfaceLook& look, int by) {
  keyframes_ += by;
  for (std::size_t c = 0; c < 3; ++c) rgb_sum_[c] += by * look.rgb[c];
  if (!look.looked_for) return;
  if (look.label != 0) return vote({look.label, 1, 0}, by);
  silent_ += by;
  for (const std::uint16_t label : look.beside)
    if (label != 0) vote({label, 0, 1}, by);
}

void VoxelLook::vote(const Votes& votes, int by) {
  auto at = std::ranges::lower_bound(votes_, votes.label, {}, &Votes::label);
  if (at == votes_.end() || at->label != votes.label) at = votes_.insert(at, {votes.label, 0, 0});
  at->count += by * votes.count;
  at->against += by * votes.against;
  if (at->count == 0 && at->against == 0) votes_.erase(at);
}

void VoxelLook::add(const VoxelLook& other) {
  keyframes_ += other.keyframes_;
  for (std::size_t c = 0; c < 3; ++c) rgb_sum_[c] += other.rgb_sum_[c];
  silent_ += other.silent_;
  for (const Votes& votes : other.votes_) vote(votes, 1);
}

VoxelLook VoxelLook::relabelled(std::span<const std::uint16_t> index_of) const {
  VoxelLook look = *this;
  look.votes_.clear();
  for (const Votes& votes : votes_)  // a full table has no index for some
    if (const std::uint16_t label = index_of[votes.label]; label != 0)
      look.vote({label, votes.count, votes.against}, 1);
  return look;
}

std::array<std::uint8_t, 3> VoxelLook::color() const {
  const auto channel = [&](std::size_t c) {
    return static_cast<std::uint8_t>((2 * rgb_sum_[c] + keyframes_) / (2 * keyframes_));
  };
  if (keyframes_ <= 0) return {255, 255, 255};
  return {channel(0), channel(1), channel(2)};
}

std::uint16_t VoxelLook::label() const {
  if (votes_.empty()) return 0;
  const Votes& best = *std::ranges::max_element(votes_, {}, &Votes::count);  // the first of equal ones
  std::int32_t all = best.against;
  for (const Votes& votes : votes_) all += votes.count;
  const bool is_heard = kLabelParts * best.count >= all && kSilentPerVote * best.count > silent_;
  return is_heard ? best.label : std::uint16_t{0};
}

void VoxelLook::put(map_file::ByteWriter& writer) const {
  for (const auto sum : rgb_sum_) writer.put(sum);
  writer.put(keyframes_);
  writer.put(silent_);
  writer.put_count(votes_.size());
  for (const Votes& votes : votes_) {
    writer.put(votes.label);
    writer.put(votes.count);
    writer.put(votes.against);
  }
}

VoxelLook VoxelLook::get(map_file::ByteReader& reader, std::size_t labels) {
  VoxelLook look;
  for (auto& sum : look.rgb_sum_) sum = reader.get<std::int32_t>();
  look.keyframes_ = reader.get<std::int32_t>();
  look.silent_ = reader.get<std::int32_t>();
  const auto is_count = [](std::int32_t n) { return n >= 0 && n <= kMostKeyframes; };
  if (!is_count(look.keyframes_) || !is_count(look.silent_))
    reader.refuse("an impossible number of keyframes");
  for (const auto sum : look.rgb_sum_)
    if (sum < 0 || sum > std::int64_t{255} * look.keyframes_) reader.refuse("a colour outside 0 … 255");
  look.votes_.resize(reader.get_count(sizeof(std::uint16_t) + 2 * sizeof(std::int32_t)));
  std::uint16_t last = 0;
  for (Votes& votes : look.votes_) {
    votes.label = reader.get<std::uint16_t>();
    votes.count = reader.get<std::int32_t>();
    votes.against = reader.get<std::int32_t>();
    if (votes.label >= labels || votes.label <= last)
      reader.refuse(fmt::format("label {} of {}", votes.label, labels));
    if (!is_count(votes.count) || !is_count(votes.against) || votes.count + votes.against == 0)
      reader.refuse("an impossible number of votes");
    last = votes.label;
  }
  return look;
}

}  // namespace rds::mapper
