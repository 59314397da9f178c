// SPDX-License-Identifier: Apache-2.0
// What MapperService does with messages before any of them changes the map.
#include <spdlog/spdlog.h>

#include "common/messages/conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"
#include "common/topics/topics.hpp"
#include "services/mapper/input/conversions.hpp"
#include "services/mapper/mapper_service.hpp"

namespace rds::mapper {

/// Messages may change which epoch counts, what waits and which poses are known; the map changes in idle().
void MapperService::take_messages() {
  while (const auto images = inboxes_.images.try_pop())  // first: they begin an epoch
    guarded(topics::kKeyframeImages.name, [&] { take(*images); });
  while (const auto boxes = inboxes_.boxes.try_pop()) guarded(topics::kBoxes.name, [&] { take(*boxes); });
  while (const auto poses = inboxes_.poses.try_pop())
    guarded(topics::kKeyframePoses.name, [&] { take(*poses); });
}

bool MapperService::is_of_tracker(std::uint64_t instance, std::uint64_t map_epoch, const std::string& topic) {
  const auto refusal =
      epochs_.hear_tracker(instance, map_epoch, mapper_.map().epoch, EpochFollower::Clock::now());
  if (refusal) context_.diagnostics.reject(topic, refusal->code, refusal->reason);
  return !refusal;
}

void MapperService::take(const Images& images) {
  if (!is_of_tracker(images->instance(), images->map_epoch(), topics::kKeyframeImages.name)) return;
  if (images->map_epoch() == mapper_.map().epoch) return queue_.add(images);
  const auto first = mapper_.archive().size() == 0 ? std::vector{images} : epochs_.confirm(images);
  if (first.empty()) return;
  begin_epoch(images->map_epoch(), messages::to_nanoseconds(first.front()->header().stamp()));
  for (const Images& keyframe : first) queue_.add(keyframe);
}

void MapperService::take(const Boxes& boxes) {
  const IntegratedKeyframe* late_for = queue_.add(boxes);
  if (late_for == nullptr) return;
  if (const auto labelled = to_labelled_boxes(*boxes, *late_for, config_.mapper, context_.diagnostics))
    mapper_.set_boxes(late_for->id, *labelled);
}

void MapperService::take(const Poses& message) {
  if (!is_of_tracker(message->instance(), message->map_epoch(), topics::kKeyframePoses.name)) return;
  const auto poses = messages::to_keyframe_poses(*message);
  if (!poses)
    return context_.diagnostics.reject(topics::kKeyframePoses.name, service::Rejection::kInvalid,
                                       poses.error());
  if (message->map_epoch() != mapper_.map().epoch) {
    if (config_.localize_only) {
      begin_epoch(message->map_epoch(), messages::to_nanoseconds(message->header().stamp()));
    } else {  // only keyframes begin an epoch
      epochs_.keep(message);
      const Images first = epochs_.confirm(message);
      if (first) {
        begin_epoch(first->map_epoch(), messages::to_nanoseconds(first->header().stamp()));
        queue_.add(first);
      }
      return;
    }
  }
  poses_.take(*message, *poses);
  if (message->base_revision() == 0 && !config_.lockstep) mapper_.make_others_final(poses_.poses());
}

/// A new epoch is a new tracker, with the saved map or an empty one.
/// @param stamp_ns  of what it begins with: earlier boxes are of an epoch that is over.
void MapperService::begin_epoch(std::uint64_t map_epoch, std::int64_t stamp_ns) {
  spdlog::info("map epoch {:016x}", map_epoch);
  const auto early = epochs_.begin(mapper_.map().epoch, EpochFollower::Clock::now());
  mapper_.reset(map_epoch);
  begin_map();
  queue_.forget_boxes_before(stamp_ns);
  if (mapper_.map().revision > 0) outputs_.publish_all(mapper_, queue_.size());
  for (const Poses& poses : early) take(poses);
}

}  // namespace rds::mapper
