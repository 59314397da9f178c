// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/scene.hpp"

#include <algorithm>
#include <array>
#include <chrono>

#include "common/service/possible_poses.hpp"
#include "common/topics/endpoints.hpp"

namespace rds::viewer {
namespace {

constexpr std::size_t kMostStates = 64;  // two seconds of frames: the path is made of each
constexpr std::size_t kMostPoses = 64;
constexpr std::size_t kMostReports = 64;
constexpr std::size_t kMostLoops = 10000;
constexpr const char* kHardware = "rds-slam";  // diagnostics of others are not looked at

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

KeyValues values_of(const diagnostic_msgs::msg::DiagnosticStatus& status) {
  KeyValues values;
  for (const auto& value : status.values()) {
    if (values.size() >= kMostFigures) break;
    values.emplace_back(value.key(), value.value());
  }
  return values;
}

}  // namespace

Scene::Scene(service::ServiceContext& context, const ViewerServiceConfig& config, Board& board,
             std::function<void()> notify)
    : context_(context),
      board_(board),
      notify_(std::move(notify)),
      tracker_(context.bus, service::kTracker),
      states_(mailbox_, kMostStates),
      boxes_(mailbox_, 1),
      poses_(mailbox_, kMostPoses),
      objects_(mailbox_, 1),
      grids_(mailbox_, 1),
      reports_(mailbox_, kMostReports),
      camera_infos_(mailbox_, 1),
      picture_(context, config, board, mailbox_, notify_),
      map_(context, board, notify_) {
  listen_to_instances(topics::kTrackingState, states_);
  listen_to_instances(topics::kPredictedBoxes, boxes_);
  listen_to_instances(topics::kKeyframePoses, poses_);
  listen(topics::kMapObjects, objects_);
  listen(topics::kMapGrid, grids_);
  listen(topics::kDiagnostics, reports_);
  listen(topics::kCameraInfo.named(config.camera_info_topic), camera_infos_);
}

template <class Message>
void Scene::listen(const topics::Topic<Message>& topic, concurrency::Inbox<Of<Message>>& inbox) {
  subscriptions_.push_back(
      topics::subscribe(context_.bus, topic, topics::kViewer, [this, &inbox](Of<Message> message) {
        inbox.push(std::move(message));
        notify_();
      }));
}

/// Messages that name the instance of the service which wrote them, in its own name.
template <class Message>
void Scene::listen_to_instances(const topics::Topic<Message>& topic, concurrency::Inbox<Of<Message>>& inbox) {
  const auto take = [this, &inbox](Of<Message> message) {
    if constexpr (std::is_same_v<Message, rds_msgs::msg::KeyFramePoses>)
      if (!service::is_possible(*message, context_.diagnostics)) return;
    inbox.push(std::move(message));
    notify_();
  };
  const auto refuse = [this, name = topic.name] {
    context_.diagnostics.reject(name, service::Rejection::kForged, "written in another one's name");
  };
  subscriptions_.push_back(
      topics::subscribe(context_.bus, topic, topics::kViewer, owners_.only_owned(std::move(take), refuse)));
}

void Scene::take() {
  map_.take();
  while (const auto state = states_.try_pop()) take(*state);
  if (const auto boxes = boxes_.try_pop()) {
    figures_.predicted_boxes = static_cast<double>((*boxes)->ids().size());
    show(Kind::kBoxes, topics::kPredictedBoxes.name, boxes_frame(**boxes));
  }
  while (const auto poses = poses_.try_pop()) take(*poses);
  if (const auto objects = objects_.try_pop()) {
    figures_.objects = static_cast<double>((*objects)->detections().size());
    show(Kind::kObjects, topics::kMapObjects.name, objects_frame(**objects));
  }
  if (const auto grid = grids_.try_pop()) show(Kind::kGrid, topics::kMapGrid.name, grid_frame(**grid));
  while (const auto report = reports_.try_pop()) take(*report);
  if (const auto info = camera_infos_.try_pop())
    show(Kind::kCamera, topics::kCameraInfo.name, messages::to_camera_model(**info).map(camera_frame));
  picture_.take();
}

void Scene::show(Kind kind, const char* topic, Expected<Bytes> frame) {
  if (!frame) return context_.diagnostics.reject(topic, service::Rejection::kInvalid, frame.error());
  board_.put(kind, std::move(*frame));
}

void Scene::take(const State& state) {
  if (!tracker_.accept(state->instance(), state->map_epoch() == map_epoch_))
    return context_.diagnostics.reject(topics::kTrackingState.name, service::Rejection::kForeign,
                                       "another tracker");
  if (state->map_epoch() != map_epoch_) {
    forget_path();
    submap_.clear();
  }
  map_epoch_ = state->map_epoch();
  namespace States = rds_msgs::msg::TrackingState_Constants;
  const bool is_in_submap = state->state() == States::SUBMAP;
  auto frame = tracking_frame(*state, is_in_submap ? submap_.camera(*state) : std::nullopt);
  const auto& at = state->map_from_camera().position();
  constexpr std::array kPlaced{States::TRACKING, States::WEAK, States::RELOCALISED};
  if (frame && std::ranges::find(kPlaced, state->state()) != kPlaced.end()) {
    board_.path.add(Eigen::Vector3d(at.x(), at.y(), at.z()).cast<float>());
    if (submap_.leave()) show_submap();
  }
  show(Kind::kTracking, topics::kTrackingState.name, std::move(frame));
  figures_.tracking_state = state->state();
  figures_.inliers = state->inliers();
  figures_.features = state->features();
  figures_.dynamic_features = state->dynamic_features();
  figures_.frames = static_cast<double>(state->frame_index()) + 1;
  figures_.frames_dropped = static_cast<double>(state->frames_dropped());
  frame_times_.add(state->total_us() / 1e6);
}

void Scene::take(const Poses& poses) {
  if (poses->source() == messages::kPosesOfTracker || poses->source() == messages::kPosesOfSubmap)
    return take_of_tracker(poses);
  if (poses->source() != messages::kPosesOfLoopCloser) return;
  if (poses->map_epoch() != map_epoch_ && map_epoch_ != 0) return;
  figures_.loops_closed = poses->loops_closed();
  loops_.clear();
  for (std::size_t i = 0; i + 1 < poses->loops().size() && loops_.size() < kMostLoops; i += 2)
    loops_.push_back({poses->loops()[i], poses->loops()[i + 1]});
  board_.put(Kind::kKeyframes, keyframes_frame(Kind::kKeyframes, keyframes_.poses(), loops_));
}

void Scene::take_of_tracker(const Poses& poses) {
  const auto converted = messages::to_keyframe_poses(*poses);
  if (!converted)
    return context_.diagnostics.reject(topics::kKeyframePoses.name, service::Rejection::kInvalid,
                                       converted.error());
  if (!tracker_.accept(poses->instance(), poses->map_epoch() == map_epoch_)) return;
  if (poses->map_epoch() != map_epoch_) {
    forget_path();
    keyframes_.clear();
    submap_.clear();
    loops_.clear();
  }
  map_epoch_ = poses->map_epoch();
  if (poses->source() == messages::kPosesOfSubmap) {
    submap_.take(*poses, *converted);
    return show_submap();
  }
  if (!keyframes_.take(*poses, *converted)) return;  // the next message with all is on its way
  const auto all = keyframes_.poses();
  figures_.keyframes = static_cast<double>(all.size());
  board_.put(Kind::kKeyframes, keyframes_frame(Kind::kKeyframes, all, loops_));
}

void Scene::take(const Report& report) {
  for (const auto& status : report->status())
    if (status.hardware_id() == kHardware)
      services_.take(status.name(), figures_of(status.level(), status.message(), values_of(status)), now_s());
}

std::string Scene::metrics(double now, std::size_t clients) {
  figures_.map_voxels = static_cast<double>(board_.map.voxels());
  figures_.map_revision = static_cast<double>(board_.map.revision());
  figures_.clients = static_cast<double>(clients);
  return metrics_text(figures_, frame_times_, services_, now);
}

}  // namespace rds::viewer
