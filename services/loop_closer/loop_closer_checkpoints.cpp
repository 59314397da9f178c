// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/loop_closer_checkpoints.hpp"

#include "common/map_file/byte_reader.hpp"
#include "services/loop_closer/core/keyframe_bytes.hpp"

namespace rds::loop_closer {
namespace {

constexpr const char* kKeyframe = "keyframe";
constexpr const char* kStart = "start";
constexpr std::size_t kMaxWaitingBytes = 64'000'000;  // while the disk is full; then keyframes are not kept

store::Bytes to_bytes(std::uint64_t number) {
  map_file::ByteWriter writer;
  writer.put(number);
  return writer.take();
}

}  // namespace

tl::expected<void, std::string> LoopCloserCheckpoints::restore(LoopCloser& loop_closer) {
  if (!writer_) return {};
  if (const auto began_with = writer_->get(kStart, 0); began_with != to_bytes(start_)) {
    begin_anew();
    return {};
  }
  std::optional<Last> last;
  std::string fault;
  const auto read = writer_->for_each(kKeyframe, [&](std::uint64_t, std::span<const std::uint8_t> bytes) {
    const auto keyframe = keyframe_from_bytes(bytes);
    if (!keyframe) fault = keyframe.error();
    if (!fault.empty()) return;
    if (loop_closer.add(*keyframe).refused.empty()) last = Last{keyframe->map_epoch, keyframe->id};
  });
  if (!read) return read;
  if (!fault.empty()) return tl::unexpected(fault);
  if (last) map_epoch_ = last->map_epoch;
  loop_closer.count_anew();
  restored_ = last;
  return {};
}

void LoopCloserCheckpoints::add(const KeyframeFeatures& keyframe) {
  if (!writer_) return;
  if (map_epoch_ != keyframe.map_epoch) begin_anew();
  map_epoch_ = keyframe.map_epoch;
  schedule_.note_keyframe();
  if (changes_.bytes() < kMaxWaitingBytes) changes_.put(kKeyframe, keyframe.id, to_bytes(keyframe));
}

void LoopCloserCheckpoints::clear() {
  restored_.reset();
  begin_anew();
}

void LoopCloserCheckpoints::begin_anew() {
  map_epoch_.reset();
  changes_.clear();
  changes_.put(kStart, 0, to_bytes(start_));
}

void LoopCloserCheckpoints::save(bool now) {
  if (!writer_ || changes_.empty() || (!now && !schedule_.is_due())) return;
  schedule_.restart();
  (void)writer_->write(changes_);  // where too much waits these wait here for the next time
}

}  // namespace rds::loop_closer
