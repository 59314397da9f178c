// SPDX-License-Identifier: Apache-2.0
#include "services/transformer/transformer_service.hpp"

#include "common/messages/conversions.hpp"
#include "common/messages/detection_conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"
#include "common/messages/keyframe_pose_table.hpp"
#include "common/service/possible_poses.hpp"
#include "common/topics/endpoints.hpp"

namespace rds::transformer {
namespace {
constexpr std::size_t kMaxWaiting = 100;
constexpr std::size_t kMaxPoses = 2000;
}  // namespace

TransformerService::TransformerService(service::ServiceContext& context,
                                       const TransformerServiceConfig& config)
    : Service(context),
      config_(config),
      tracker_(context.bus, service::kTracker),
      poses_(kMaxPoses),
      detections_inbox_(mailbox_, kMaxWaiting),
      poses_inbox_(mailbox_, kMaxWaiting),
      camera_inbox_(mailbox_, 1),
      boxes_(topics::advertise(context.bus, topics::kBoxes, topics::kTransformer)) {
  subscriptions_.push_back(topics::subscribe(context.bus, topics::kDetections, topics::kTransformer,
                                             [this](Detections m) { detections_inbox_.push(std::move(m)); }));
  subscriptions_.push_back(
      subscribe_to_instances(topics::kKeyframePoses, topics::kTransformer, [this](Poses m) {
        if (m->source() != messages::kPosesOfLoopCloser && service::is_possible(*m, context_.diagnostics))
          poses_inbox_.push(std::move(m));
      }));
  subscriptions_.push_back(topics::subscribe(context.bus, topics::kCameraInfo.named(config.camera_info_topic),
                                             topics::kTransformer,
                                             [this](Info m) { camera_inbox_.push(std::move(m)); }));
}

void TransformerService::reconfigure(const TransformerServiceConfig& config) {
  config_.transformer.min_depth_m = config.transformer.min_depth_m;
  config_.transformer.max_depth_m = config.transformer.max_depth_m;
}

void TransformerService::run(const std::stop_token& stop) {
  while (wait(stop, [this] {
    return !detections_inbox_.locked_empty() || !poses_inbox_.locked_empty() ||
           !camera_inbox_.locked_empty() || !commands_.locked_empty();
  })) {
    handle_commands();
    guarded(config_.camera_info_topic, [this] { take_camera(); });
    take_pose_messages();
    take_detections();
    lift_what_is_complete();
  }
}

void TransformerService::take_camera() {
  const auto info = camera_inbox_.try_pop();
  if (!info) return;
  const auto camera = messages::to_camera_model(**info);
  if (camera)
    camera_ = *camera;
  else
    context_.diagnostics.reject(config_.camera_info_topic, service::Rejection::kInvalid, camera.error());
}

void TransformerService::take_pose_messages() {
  while (const auto message = poses_inbox_.try_pop())
    guarded(topics::kKeyframePoses.name, [&] { take(*message); });
}

void TransformerService::take(const Poses& message) {
  const auto poses = messages::to_keyframe_poses(*message);
  if (!poses)
    return context_.diagnostics.reject(topics::kKeyframePoses.name, service::Rejection::kInvalid,
                                       poses.error());
  if (!tracker_.accept(message->instance(), message->map_epoch() == map_epoch_))
    return context_.diagnostics.reject(topics::kKeyframePoses.name, service::Rejection::kForeign,
                                       "another tracker");
  if (message->map_epoch() != map_epoch_) poses_.clear();
  map_epoch_ = message->map_epoch();
  poses_.take(*poses);
}

void TransformerService::take_detections() {
  while (auto detections = detections_inbox_.try_pop()) {
    if (paused_)
      ++context_.diagnostics.counter("detections while paused");
    else
      waiting_.push_back(std::move(*detections));
  }
  while (waiting_.size() > kMaxWaiting) {
    context_.diagnostics.reject(topics::kDetections.name, service::Rejection::kUnexpected,
                                "the keyframe's pose or the camera never came");
    waiting_.pop_front();
  }
}

void TransformerService::lift_what_is_complete() {
  if (!camera_) return;
  std::erase_if(waiting_, [this](const Detections& detections) {
    const auto map_from_camera = poses_.of(messages::to_nanoseconds(detections->header().stamp()));
    if (!map_from_camera) return false;
    guarded(topics::kDetections.name, [&] { lift(detections, *map_from_camera); });
    return true;
  });
}

void TransformerService::lift(const Detections& detections, const geometry::Pose& map_from_camera) {
  const auto found = messages::to_detections(*detections);
  if (!found)
    return context_.diagnostics.reject(topics::kDetections.name, service::Rejection::kInvalid, found.error());
  std::vector<messages::SpatialDetection> boxes;
  for (const auto& detection : *found) {
    const auto volume = box_in_map(detection.box, detection.depth_m, detection.label, map_from_camera,
                                   *camera_, config_.transformer);
    if (volume)
      boxes.push_back({detection.label, detection.score, *volume, {}});
    else
      ++context_.diagnostics.counter("boxes without a place in the map");
  }
  const auto header =
      messages::make_header(messages::to_nanoseconds(detections->header().stamp()), context_.frame("map"));
  boxes_.write(messages::to_detection_message(boxes, header));
}

service::CommandOutcome TransformerService::execute(const std::string& verb,
                                                    const std::string& /*argument*/) {
  if (verb == "reset") {
    poses_.clear();
    waiting_.clear();
    return {true, "forgot all keyframe poses"};
  }
  if (verb == "pause" || verb == "resume") {
    paused_ = verb == "pause";
    return {true, paused_ ? "paused" : "resumed"};
  }
  return unknown_command(verb);
}

}  // namespace rds::transformer
