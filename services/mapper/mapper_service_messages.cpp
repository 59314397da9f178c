// SPDX-License-Identifier: Apache-2.0
// What MapperService does with messages before any of them changes the map.
#include <limits>
#include <utility>

#include <spdlog/spdlog.h>

#include "common/messages/conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"
#include "common/topics/topics.hpp"
#include "services/mapper/input/labelled_boxes.hpp"
#include "services/mapper/mapper_service.hpp"

namespace rds::mapper {
namespace {

constexpr std::size_t kMaxEarlierEpochs = 16;
constexpr std::uint8_t kLocal = 0;
constexpr std::size_t kMaxEarlyPoses = 100;
constexpr std::chrono::seconds kSilent{3};
constexpr std::uint64_t kPosesMark = std::numeric_limits<std::uint64_t>::max();  // no keyframe's id

}  // namespace

bool MapperService::has_messages() const {
  return !images_inbox_.locked_empty() || !boxes_inbox_.locked_empty() || !poses_inbox_.locked_empty();
}

void MapperService::take_messages() {
  while (const auto images = images_inbox_.try_pop())  // first: they begin an epoch
    guarded(topics::kKeyframeImages.name, [&] { take(*images); });
  while (const auto boxes = boxes_inbox_.try_pop()) guarded(topics::kBoxes.name, [&] { take(*boxes); });
  while (const auto poses = poses_inbox_.try_pop())
    guarded(topics::kKeyframePoses.name, [&] { take(*poses); });
}

/// One tracker is followed, and of that one its newest epoch: messages of others change nothing.
bool MapperService::is_of_tracker(std::uint64_t instance, std::uint64_t map_epoch, const std::string& topic) {
  const bool same_map = map_epoch == mapper_.map_epoch();
  if (!tracker_.accept(instance, same_map)) {
    context_.diagnostics.reject(topic, service::Rejection::kForeign, "another tracker");
    return false;
  }
  if (instance != tracker_instance_) {
    earlier_epochs_.clear();
    loops_ = {};
  }
  tracker_instance_ = instance;
  if (same_map) {
    another_epoch_.deny();
    heard_of_epoch_ = std::chrono::steady_clock::now();
  }
  if (same_map || !is_over(map_epoch)) return true;
  context_.diagnostics.reject(topic, service::Rejection::kOutdated, "an earlier map epoch");
  return false;
}

/// Messages of an epoch that is over may still be on their way; but who is followed decides: an epoch that
/// goes on while the one that followed it is silent is not over.
bool MapperService::is_over(std::uint64_t map_epoch) {
  if (std::ranges::count(earlier_epochs_, map_epoch) == 0) return false;
  if (std::chrono::steady_clock::now() - heard_of_epoch_ < kSilent) return true;
  std::erase(earlier_epochs_, map_epoch);
  return false;
}

bool MapperService::is_of_loop_closer(const Poses& poses) {
  const bool known = poses->map_epoch() == mapper_.map_epoch();
  const bool accepted = known && loop_closer_.accept(poses->instance(), false);
  if (!known)
    context_.diagnostics.reject(topics::kKeyframePoses.name, service::Rejection::kOutdated,
                                "loops of another map epoch");
  else if (!accepted)
    context_.diagnostics.reject(topics::kKeyframePoses.name, service::Rejection::kForeign,
                                "another loop closer");
  return accepted;
}

/// A new epoch is a new tracker, with the saved map or an empty one.
/// @param stamp_ns  of what it begins with: earlier boxes are of an epoch that is over.
void MapperService::begin_epoch(std::uint64_t map_epoch, std::int64_t stamp_ns) {
  earlier_epochs_.push_back(mapper_.map_epoch());
  if (earlier_epochs_.size() > kMaxEarlierEpochs) earlier_epochs_.pop_front();
  spdlog::info("map epoch {:016x}", map_epoch);
  heard_of_epoch_ = std::chrono::steady_clock::now();
  mapper_.reset(map_epoch);
  outputs_.begin_map();
  forget_keyframes();
  waiting_boxes_.forget_before(stamp_ns);
  if (mapper_.revision() > 0) publish_all();
  for (const Poses& early : std::exchange(early_poses_, {})) take(early);
}

/// Where there is a map to lose, another epoch begins with its second message; the first one waits for it.
bool MapperService::is_confirmed(const Images& images) {
  if (mapper_.archive().size() == 0) return true;
  if (!another_epoch_.confirm(images->instance(), images->map_epoch(), images->keyframe_id())) {
    first_of_epoch_ = images;
    return false;
  }
  const Images first = std::exchange(first_of_epoch_, nullptr);
  if (first && first != images && first->map_epoch() == images->map_epoch()) {
    begin_epoch(first->map_epoch(), messages::to_nanoseconds(first->header().stamp()));
    take(first);
    take(images);
    return false;  // it is taken
  }
  return true;
}

void MapperService::forget_keyframes() {
  waiting_.clear();
  integrated_by_stamp_.clear();
  poses_.clear();
  tracker_poses_.clear();
  poses_changed_by_loop_ = false;
  poses_revision_ = last_keyframe_id_ = 0;
  loops_ = {};
}

void MapperService::take(const Images& images) {
  if (!is_of_tracker(images->instance(), images->map_epoch(), topics::kKeyframeImages.name)) return;
  const std::int64_t stamp = messages::to_nanoseconds(images->header().stamp());
  if (images->map_epoch() != mapper_.map_epoch()) {
    if (!is_confirmed(images)) return;
    begin_epoch(images->map_epoch(), stamp);
  }
  const auto integrated = integrated_by_stamp_.find(stamp);
  const bool is_integrated =
      integrated != integrated_by_stamp_.end() && integrated->second.id >= images->keyframe_id();
  if (!is_integrated) waiting_.add(images);
}

/// Of keyframes with one stamp (a recording that is played again) they are of the newest.
void MapperService::take(const Boxes& boxes) {
  const std::int64_t stamp = messages::to_nanoseconds(boxes->header().stamp());
  const auto integrated = integrated_by_stamp_.find(stamp);
  if (integrated == integrated_by_stamp_.end() || waiting_.contains(stamp)) {
    waiting_boxes_.add(stamp, boxes);
  } else {
    const auto& [id, made, camera_from_map, camera] = integrated->second;
    if (const auto labelled = labelled_boxes(boxes, camera_from_map, camera))
      mapper_.set_boxes(id, *labelled);
  }
}

/// @return nullopt, counted, for a message that cannot be used; boxes that cannot be are counted and left
/// out.
std::optional<std::vector<LabelledBox>> MapperService::labelled_boxes(const Boxes& boxes,
                                                                      const geometry::Pose& camera_from_map,
                                                                      const geometry::CameraModel& camera) {
  auto labelled = to_labelled_boxes(*boxes, camera_from_map, camera, config_.mapper);
  if (!labelled) {
    context_.diagnostics.reject(topics::kBoxes.name, service::Rejection::kInvalid, labelled.error());
    return std::nullopt;
  }
  context_.diagnostics.counter("impossible boxes") += labelled->impossible;
  return std::move(labelled->boxes);
}

/// Only keyframes begin an epoch; without them (localize_only) poses do.
void MapperService::take(const Poses& message) {
  const bool local = message->source() == kLocal;
  if (local && !is_of_tracker(message->instance(), message->map_epoch(), topics::kKeyframePoses.name)) return;
  if (!local && !is_of_loop_closer(message)) return;
  auto poses = messages::to_keyframe_poses(*message);
  if (!poses)
    return context_.diagnostics.reject(topics::kKeyframePoses.name, service::Rejection::kInvalid,
                                       poses.error());
  if (message->map_epoch() != mapper_.map_epoch()) {
    if (!config_.localize_only) {
      if (early_poses_.size() >= kMaxEarlyPoses)
        early_poses_.clear();           // the next ones with all poses will do
      early_poses_.push_back(message);  // all of them: the first tells all poses, the next ones what changed
      const bool confirmed =
          local && another_epoch_.confirm(message->instance(), message->map_epoch(), kPosesMark);
      if (confirmed && first_of_epoch_ && first_of_epoch_->map_epoch() == message->map_epoch())
        take(Images(first_of_epoch_));
      return;
    }
    begin_epoch(message->map_epoch(), messages::to_nanoseconds(message->header().stamp()));
  }
  if (local) {
    if (!tracker_poses_.take(*message, *poses)) return;  // until all are told
    *poses = tracker_poses_.poses();
    if (message->base_revision() == 0 && !config_.lockstep) mapper_.make_others_final(*poses);
  }
  if (loops_.is_older(message->loop_instance(), message->loop_revision()))
    return;  // does not know the loop yet that we have applied
  if (poses->empty()) return;
  poses_changed_by_loop_ |= loops_.is_newer(message->loop_instance(), message->loop_revision());
  loops_.take(message->loop_instance(), message->loop_revision());
  poses_ = std::move(*poses);
  if (local) poses_revision_ = message->revision();
}

}  // namespace rds::mapper
