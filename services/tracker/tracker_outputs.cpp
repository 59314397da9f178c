// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_outputs.hpp"

#include <algorithm>

#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"
#include "common/time/steady_time.hpp"
#include "common/topics/endpoints.hpp"
#include "services/tracker/obstacles/obstacle_cloud.hpp"

namespace rds::tracker {
namespace {

/// A mono8 image of the mask's cells, without pixels if nothing is movable.
sensor_msgs::msg::Image movable_cells(const MovableMask& movable, const std_msgs::msg::Header& header) {
  return messages::to_image_message(movable.any() ? movable.cells() : cv::Mat1b(), header);
}

void fill(rds_msgs::msg::KeyFrameFeatures& message, const KeyframeData& keyframe) {
  message.keyframe_id(keyframe.id);
  message.map_from_camera(messages::to_pose_message(keyframe.map_from_camera));
  const std::size_t count = keyframe.features.size();
  message.keypoints().reserve(4 * count);
  message.points().reserve(3 * count);
  message.descriptors().reserve(32 * count);
  for (const KeyframeFeature& f : keyframe.features) {
    const Feature& feature = f.feature;
    message.keypoints().insert(
        message.keypoints().end(),
        {feature.px.x(), feature.px.y(), static_cast<float>(feature.level), feature.angle_rad});
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(feature.descriptor.data());
    message.descriptors().insert(message.descriptors().end(), bytes, bytes + 32);
    message.points().insert(message.points().end(), f.point_in_camera.data(), f.point_in_camera.data() + 3);
    message.map_point_ids().push_back(f.map_point_id);
    message.movable().push_back(feature.movable ? 1 : 0);
  }
  for (const CovisiblePose& covisible : keyframe.covisible) {
    message.covisible_keyframes().push_back(covisible.id);
    message.covisible_weights().push_back(static_cast<std::uint32_t>(covisible.weight));
    messages::append_pose(covisible.map_from_camera, message.covisible_poses());
  }
}

/// Behind those that share points: the loop closer goes on from where the tracker has them by now.
void append_moved(rds_msgs::msg::KeyFrameFeatures& message, std::span<const KeyframePose> moved) {
  const std::vector<std::uint64_t> told = message.covisible_keyframes();
  for (const KeyframePose& pose : moved) {
    if (pose.id == message.keyframe_id() || std::ranges::find(told, pose.id) != told.end()) continue;
    message.covisible_keyframes().push_back(pose.id);
    message.covisible_weights().push_back(0);
    messages::append_pose(pose.map_from_camera, message.covisible_poses());
  }
}

/// Whether the frame's poses are in the map, and not in a submap.
bool is_placed(const FrameReport& report) {
  return report.result.submap == Submaps::kMap;
}

void append(std::vector<double>& flat, const Eigen::Vector3d& v) {
  flat.insert(flat.end(), v.data(), v.data() + 3);
}

}  // namespace

TrackerOutputs::TrackerOutputs(service::ServiceContext& context, const FramesConfig& frames,
                               std::uint64_t map_epoch)
    : instance_(context.instance),
      map_epoch_(map_epoch),
      map_frame_(context.frame("map")),
      submap_frame_(context.frame("submap")),
      default_camera_frame_(context.frame("camera_color_optical_frame")),
      odometry_(context, frames),
      path_(context),
      state_(topics::advertise(context.bus, topics::kTrackingState, topics::kTracker)),
      boxes_(topics::advertise(context.bus, topics::kPredictedBoxes, topics::kTracker)),
      obstacles_(topics::advertise(context.bus, topics::kObstacles, topics::kTracker)),
      features_(topics::advertise(context.bus, topics::kFeatures, topics::kTracker)),
      keyframe_images_(topics::advertise(context.bus, topics::kKeyframeImages, topics::kTracker)),
      keyframe_features_(topics::advertise(context.bus, topics::kKeyframeFeatures, topics::kTracker)),
      keyframe_poses_(topics::advertise(context.bus, topics::kKeyframePoses, topics::kTracker)),
      sharing_(context, map_epoch) {}

void TrackerOutputs::set_epoch(std::uint64_t map_epoch) {
  map_epoch_ = map_epoch;
  pose_changes_.clear();
  submap_changes_.clear();
  moved_.clear();
  odometry_.begin_map();
  sharing_.begin(map_epoch);
}

bool TrackerOutputs::has_new_reader() {
  const int readers = keyframe_poses_.matched();
  informed_readers_ = std::min(informed_readers_, readers);
  return readers > informed_readers_ || path_.has_new_reader();
}

void TrackerOutputs::publish(const FrameReport& report) {
  if (has_pose(report.result.state))
    odometry_.publish(report.frame.stamp_ns, report.result, camera_frame(report));
  publish_boxes(report);
  publish_obstacles(report);
  publish_features(report);
  std::optional<PublishedKeyframe> keyframe;
  if (report.result.keyframe) keyframe = publish_keyframe(report);
  publish_state(report);
  if (keyframe) share(*std::move(keyframe));
}

const std::string& TrackerOutputs::camera_frame(const FrameReport& report) const {
  return report.camera_frame.empty() ? default_camera_frame_ : report.camera_frame;
}

/// A message about a frame. @param frame_id  that it is in.
template <class Message>
Message TrackerOutputs::about(const FrameReport& report, const std::string& frame_id) const {
  Message message;
  message.header(messages::make_header(report.frame.stamp_ns, frame_id));
  message.instance(instance_);
  message.map_epoch(map_epoch_);
  message.frame_index(report.frame_index);
  return message;
}

void TrackerOutputs::publish_boxes(const FrameReport& report) {
  auto message = about<rds_msgs::msg::PredictedBoxes>(report, is_placed(report) ? map_frame_ : submap_frame_);
  for (const auto& [object, box] : report.objects) {
    const geometry::Box3 volume = object.box.axis_aligned_hull();
    message.ids().push_back(object.id);
    message.labels().push_back(object.label);
    message.scores().push_back(object.score);
    for (const double edge : {box.x0, box.y0, box.x1, box.y1})
      message.boxes().push_back(static_cast<float>(edge));
    append(message.minimums(), volume.min);
    append(message.maximums(), volume.max);
    append(message.velocities(), object.velocity);
    message.covariance_traces().push_back(object.covariance_trace);
    message.ages().push_back(object.age_s);
  }
  boxes_.write(message);
}

/// What stands in the way now, while somebody reads it. A frame without a place in the map does not know
/// where that is.
void TrackerOutputs::publish_obstacles(const FrameReport& report) {
  if (obstacles_.matched() == 0 || !has_pose(report.result.state) || !is_placed(report)) return;
  obstacles_.write(obstacle_cloud(report.objects, messages::make_header(report.frame.stamp_ns, map_frame_)));
}

void TrackerOutputs::publish_features(const FrameReport& report) {
  if (features_.matched() == 0) return;
  auto message = about<rds_msgs::msg::FrameFeatures>(report, camera_frame(report));
  message.positions().reserve(2 * report.result.verdicts.size());
  for (const KeypointVerdict& verdict : report.result.verdicts) {
    message.positions().push_back(verdict.image_px.x());
    message.positions().push_back(verdict.image_px.y());
    message.verdicts().push_back(static_cast<std::uint8_t>(verdict.use));
  }
  message.movable(movable_cells(report.result.movable, message.header()));
  features_.write(message);
}

TrackerOutputs::PublishedKeyframe TrackerOutputs::publish_keyframe(const FrameReport& report) {
  const KeyframeData& keyframe = *report.result.keyframe;
  auto images = about<rds_msgs::msg::KeyFrameImages>(report, camera_frame(report));
  images.keyframe_id(keyframe.id);
  images.submap(report.result.submap);
  images.map_from_camera(messages::to_pose_message(keyframe.map_from_camera));
  images.camera_info(messages::to_camera_info(report.frame.camera, images.header()));
  images.color(messages::to_image_message(report.frame.color, images.header()));
  images.depth(messages::to_image_message(report.frame.depth, images.header()));
  images.movable(movable_cells(report.result.movable, images.header()));
  keyframe_images_.write(images);
  if (!keyframe.in_map || !is_placed(report)) return {std::move(images), {}};
  return {std::move(images), write_features(keyframe, report)};
}

/// To other machines: a thread of its own begins to compress at once, and would take the processor from what
/// is yet to be published.
void TrackerOutputs::share(PublishedKeyframe&& keyframe) {
  sharing_.share(std::move(keyframe.images));
  if (keyframe.features) sharing_.share(*std::move(keyframe.features));
}

void TrackerOutputs::publish_features_of(const KeyframeData& keyframe, const FrameReport& report) {
  sharing_.share(write_features(keyframe, report));
}

/// @param report  of the newest frame: of an older keyframe it tells what is known by now.
rds_msgs::msg::KeyFrameFeatures TrackerOutputs::write_features(const KeyframeData& keyframe,
                                                               const FrameReport& report) {
  auto features = about<rds_msgs::msg::KeyFrameFeatures>(report, camera_frame(report));
  features.header().stamp(messages::to_time(keyframe.stamp_ns));
  fill(features, keyframe);
  append_moved(features, moved_.next(report.keyframe_poses));
  features.loop_instance(report.loops.instance);
  features.loop_revision(report.loops.revision);
  keyframe_features_.write(features);
  return features;
}

void TrackerOutputs::publish_state(const FrameReport& report) {
  const FrameResult& result = report.result;
  auto message = about<rds_msgs::msg::TrackingState>(report, map_frame_);
  const bool is_in_submap = has_pose(result.state) && !is_placed(report);
  message.state(is_in_submap ? rds_msgs::msg::TrackingState_Constants::SUBMAP
                             : static_cast<std::uint8_t>(result.state));
  message.features(result.features);
  message.dynamic_features(result.dynamic_features);
  message.inliers(result.inliers);
  message.is_keyframe(result.keyframe.has_value());
  if (result.keyframe) message.keyframe_id(result.keyframe->id);
  message.reference_keyframe_id(result.reference_keyframe_id);
  message.map_from_camera(
      messages::to_pose_message(is_in_submap ? geometry::Pose::Identity() : result.map_from_camera));
  message.reference_from_camera(messages::to_pose_message(result.reference_from_camera));
  message.extract_us(static_cast<std::uint32_t>(result.times.extract_us));
  message.predict_us(report.predict_us);
  message.track_us(static_cast<std::uint32_t>(result.times.track_us));
  message.total_us(time::microseconds_since(report.started_us));
  message.frames_dropped(report.frames_dropped);
  message.box_sets_used(report.box_sets_used);
  state_.write(message);
}

void TrackerOutputs::publish_submap(std::span<const KeyframePose> poses) {
  rds_msgs::msg::KeyFramePoses message;
  message.header(messages::make_header(poses.empty() ? 0 : poses.back().stamp_ns, submap_frame_));
  message.instance(instance_);
  message.map_epoch(map_epoch_);
  message.source(messages::kPosesOfSubmap);
  if (!poses.empty()) message.answered_keyframe_id(poses.back().id);
  messages::append_poses(submap_changes_.next(poses, false, message), message);
  keyframe_poses_.write(message);
}

std::uint64_t TrackerOutputs::publish_poses(std::span<const KeyframePose> poses, const LoopState& loops,
                                            bool exact) {
  rds_msgs::msg::KeyFramePoses message;
  message.header(messages::make_header(poses.empty() ? 0 : poses.back().stamp_ns, map_frame_));
  message.instance(instance_);
  message.map_epoch(map_epoch_);
  message.source(0);
  message.loop_instance(loops.instance);
  message.loop_revision(loops.revision);
  message.loops_closed(loops.loops_closed);
  if (!poses.empty()) message.answered_keyframe_id(poses.back().id);
  const int readers = keyframe_poses_.matched();
  const bool has_new = readers > informed_readers_;
  informed_readers_ = readers;
  messages::append_poses(pose_changes_.next(poses, has_new || exact, message), message);
  keyframe_poses_.write(message);
  path_.publish(poses, exact);
  return pose_changes_.revision();
}

}  // namespace rds::tracker
