// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/keyframe_answers.hpp"

#include <algorithm>
#include <chrono>

#include <spdlog/spdlog.h>

#include "common/messages/conversions.hpp"
#include "common/topics/topics.hpp"

namespace rds::tracker {
namespace {
constexpr std::size_t kMaxAnswers = 100;
constexpr std::chrono::milliseconds kBetweenBeats(
    500);  // while own threads, which always answer, take their time
}  // namespace

KeyframeAnswers::KeyframeAnswers(service::ServiceContext& context, concurrency::Mailbox& mailbox,
                                 const LockstepConfig& lockstep, int mapping_nice)
    : diagnostics_(context.diagnostics),
      mailbox_(mailbox),
      loop_closer_(context.bus, service::kLoopCloser),
      lockstep_(lockstep),
      boxes_inbox_(mailbox, kMaxAnswers),
      poses_inbox_(mailbox, kMaxAnswers),
      mapping_inbox_(mailbox, 2),
      adjustment_inbox_(mailbox, 1),
      mapping_worker_(mapping_nice, mapping_inbox_),
      adjustment_worker_(adjustment_inbox_) {}

bool KeyframeAnswers::locked_ready() const {
  return !boxes_inbox_.locked_empty() || !poses_inbox_.locked_empty() || !mapping_inbox_.locked_empty() ||
         !adjustment_inbox_.locked_empty();
}

void KeyframeAnswers::sort_in(std::uint64_t map_epoch) {
  while (auto boxes = boxes_inbox_.try_pop()) {
    const auto stamp = static_cast<std::uint64_t>(messages::to_nanoseconds((*boxes)->header().stamp()));
    if (!boxes_.arrive(stamp, std::move(*boxes)))
      diagnostics_.reject(topics::kBoxes.name, service::Rejection::kUnexpected,
                          "their keyframe waits for none");
  }
  while (auto poses = poses_inbox_.try_pop()) {
    const std::uint64_t answered = (*poses)->answered_keyframe_id();
    if ((*poses)->map_epoch() != map_epoch)
      diagnostics_.reject(topics::kKeyframePoses.name, service::Rejection::kOutdated, "another map epoch");
    else if (!loop_closer_.accept((*poses)->instance(), false))
      diagnostics_.reject(topics::kKeyframePoses.name, service::Rejection::kForeign, "another loop closer");
    else
      poses_.arrive_through(answered, *poses);
  }
  while (auto result = mapping_inbox_.try_pop()) {
    const std::uint64_t keyframe = result->keyframe;
    mappings_.arrive(keyframe, std::move(*result));
  }
  while (auto result = adjustment_inbox_.try_pop()) {
    const std::uint64_t revision = result->revision;
    adjustments_.arrive(revision, std::move(*result));
  }
}

void KeyframeAnswers::ask_for_boxes(std::int64_t stamp_ns, const KeyframeSnapshot& snapshot,
                                    std::uint64_t frame) {
  boxes_.ask(static_cast<std::uint64_t>(stamp_ns), frame + lockstep_.detection_latency_frames);
  snapshots_.insert_or_assign(stamp_ns, snapshot);
  while (snapshots_.size() > kMaxAnswers) snapshots_.erase(snapshots_.begin());
}

void KeyframeAnswers::ask_for_poses(std::uint64_t keyframe, std::uint64_t frame) {
  poses_.ask(keyframe, frame + kPosesAfter);
}

void KeyframeAnswers::ask_for_mapping(LocalMappingJob job, std::uint64_t frame) {
  mappings_.ask(job.keyframe, frame + kMappingAfter);
  mapping_worker_.start(std::move(job));
}

void KeyframeAnswers::ask_for_adjustment(LocalMappingJob job, std::uint64_t frame) {
  adjustments_.clear();
  adjustments_.ask(job.revision, frame + kAdjustmentAfter);
  adjustment_worker_.start(std::move(job));
}

void KeyframeAnswers::await(std::uint64_t frame, std::uint64_t map_epoch, const std::stop_token& stop,
                            const std::function<void()>& beat) {
  using Clock = std::chrono::steady_clock;
  if (!lockstep_.enabled) return;
  const auto deadline = Clock::now() + std::chrono::duration<double>(lockstep_.timeout_s);
  while (!stop.stop_requested()) {
    beat();
    sort_in(map_epoch);
    const bool have_own = mappings_.complete(frame) && adjustments_.complete(frame);
    if (have_own && boxes_.complete(frame) && poses_.complete(frame)) return;
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (have_own && left.count() <= 0) break;
    mailbox_.wait_for(stop, std::max(left, kBetweenBeats), [this] { return locked_ready(); });
  }
  ++diagnostics_.counter("lockstep timeouts");
  spdlog::warn("frame {} goes on without an answer it waited {} s for", frame, lockstep_.timeout_s);
}

bool KeyframeAnswers::empty() const {
  return boxes_.empty() && poses_.empty() && mappings_.empty() && adjustments_.empty();
}

std::optional<KeyframeSnapshot> KeyframeAnswers::take_snapshot(std::int64_t stamp_ns) {
  const auto snapshot = snapshots_.extract(stamp_ns);
  return snapshot ? std::optional(snapshot.mapped()) : std::nullopt;
}

void KeyframeAnswers::forget_boxes() {
  boxes_.clear();
  snapshots_.clear();
}

void KeyframeAnswers::clear() {
  forget_boxes();
  poses_.clear();
  mappings_.clear();
  adjustments_.clear();
  adjustment_worker_.stop();
}

}  // namespace rds::tracker
