// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_outputs.hpp"

#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"
#include "common/topics/endpoints.hpp"
#include "services/tracker/keyframe_message.hpp"

namespace rds::tracker {
namespace {

const std::string kMap = "map";
const std::string kOdom = "odom";
const std::string kCamera = "camera_color_optical_frame";

geometry_msgs::msg::TransformStamped transform(std::int64_t stamp_ns, const std::string& parent,
                                               const std::string& child,
                                               const geometry::Pose& parent_from_child) {
  geometry_msgs::msg::TransformStamped message;
  message.header(messages::make_header(stamp_ns, parent));
  message.child_frame_id(child);
  message.transform(messages::to_transform_message(parent_from_child));
  return message;
}

/// A mono8 image of the mask's cells, without pixels if nothing is movable.
sensor_msgs::msg::Image movable_cells(const MovableMask& movable, const std_msgs::msg::Header& header) {
  return messages::to_image_message(movable.any() ? movable.cells() : cv::Mat1b(), header);
}

void append(std::vector<double>& flat, const Eigen::Vector3d& v) {
  flat.insert(flat.end(), v.data(), v.data() + 3);
}

}  // namespace

TrackerOutputs::TrackerOutputs(service::ServiceContext& context, std::uint64_t map_epoch)
    : instance_(context.instance),
      map_epoch_(map_epoch),
      odometry_(topics::advertise(context.bus, topics::kOdometry, topics::kTracker)),
      tf_(topics::advertise(context.bus, topics::kTransforms, topics::kTracker)),
      state_(topics::advertise(context.bus, topics::kTrackingState, topics::kTracker)),
      boxes_(topics::advertise(context.bus, topics::kPredictedBoxes, topics::kTracker)),
      features_(topics::advertise(context.bus, topics::kFeatures, topics::kTracker)),
      keyframe_images_(topics::advertise(context.bus, topics::kKeyframeImages, topics::kTracker)),
      keyframe_features_(topics::advertise(context.bus, topics::kKeyframeFeatures, topics::kTracker)),
      keyframe_poses_(topics::advertise(context.bus, topics::kKeyframePoses, topics::kTracker)),
      sharing_(context) {}

void TrackerOutputs::set_epoch(std::uint64_t map_epoch) {
  map_epoch_ = map_epoch;
  pose_changes_.clear();
  map_from_odom_ = geometry::Pose::Identity();
}

void TrackerOutputs::move_map(const geometry::Pose& corrected_map_from_map) {
  map_from_odom_ = corrected_map_from_map * map_from_odom_;
}

bool TrackerOutputs::has_new_reader() {
  const int readers = keyframe_poses_.matched();
  const bool more = readers > pose_readers_;
  pose_readers_ = readers;
  reader_waits_ |= more;
  return more;
}

void TrackerOutputs::publish(const FrameReport& report) {
  if (has_pose(report.result.state)) publish_pose(report);
  publish_boxes(report);
  publish_features(report);
  if (report.result.keyframe) publish_keyframe(report);
  publish_state(report);
}

void TrackerOutputs::publish_pose(const FrameReport& report) {
  const std::int64_t stamp = report.frame.stamp_ns;
  const geometry::Pose odom_from_camera = map_from_odom_.inverse() * report.result.map_from_camera;
  nav_msgs::msg::Odometry odometry;
  odometry.header(messages::make_header(stamp, kOdom));
  odometry.child_frame_id(kCamera);
  odometry.pose().pose(messages::to_pose_message(odom_from_camera));
  odometry_.write(odometry);
  tf2_msgs::msg::TFMessage tf;
  tf.transforms().push_back(transform(stamp, kMap, kOdom, map_from_odom_));
  tf.transforms().push_back(transform(stamp, kOdom, kCamera, odom_from_camera));
  tf_.write(tf);
}

void TrackerOutputs::publish_boxes(const FrameReport& report) {
  rds_msgs::msg::PredictedBoxes message;
  message.header(messages::make_header(report.frame.stamp_ns, kMap));
  message.instance(instance_);
  message.map_epoch(map_epoch_);
  message.frame_index(report.frame_index);
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

void TrackerOutputs::publish_features(const FrameReport& report) {
  if (features_.matched() == 0) return;
  rds_msgs::msg::FrameFeatures message;
  message.header(messages::make_header(report.frame.stamp_ns, kCamera));
  message.instance(instance_);
  message.map_epoch(map_epoch_);
  message.frame_index(report.frame_index);
  message.positions().reserve(2 * report.result.verdicts.size());
  for (const KeypointVerdict& verdict : report.result.verdicts) {
    message.positions().push_back(verdict.image_px.x());
    message.positions().push_back(verdict.image_px.y());
    message.verdicts().push_back(static_cast<std::uint8_t>(verdict.use));
  }
  message.movable(movable_cells(report.result.movable, message.header()));
  features_.write(message);
}

void TrackerOutputs::publish_keyframe(const FrameReport& report) {
  const KeyframeData& keyframe = *report.result.keyframe;
  const auto header = messages::make_header(keyframe.stamp_ns, kCamera);
  rds_msgs::msg::KeyFrameImages images;
  images.header(header);
  images.instance(instance_);
  images.map_epoch(map_epoch_);
  images.keyframe_id(keyframe.id);
  images.frame_index(report.frame_index);
  images.map_from_camera(messages::to_pose_message(keyframe.map_from_camera));
  images.camera_info(messages::to_camera_info(report.frame.camera, header));
  images.color(messages::to_image_message(report.frame.color, header));
  images.depth(messages::to_image_message(report.frame.depth, header));
  images.movable(movable_cells(report.result.movable, header));
  keyframe_images_.write(images);
  sharing_.share(std::move(images));
  if (!keyframe.in_map) return;
  rds_msgs::msg::KeyFrameFeatures features = to_message(keyframe);
  features.header(header);
  features.instance(instance_);
  features.map_epoch(map_epoch_);
  features.frame_index(report.frame_index);
  keyframe_features_.write(features);
  sharing_.share(std::move(features));
}

void TrackerOutputs::publish_state(const FrameReport& report) {
  const FrameResult& result = report.result;
  rds_msgs::msg::TrackingState message;
  message.header(messages::make_header(report.frame.stamp_ns, kMap));
  message.instance(instance_);
  message.map_epoch(map_epoch_);
  message.frame_index(report.frame_index);
  message.state(static_cast<std::uint8_t>(result.state));
  message.features(result.features);
  message.dynamic_features(result.dynamic_features);
  message.inliers(result.inliers);
  message.is_keyframe(result.keyframe.has_value());
  if (result.keyframe) message.keyframe_id(result.keyframe->id);
  message.reference_keyframe_id(result.reference_keyframe_id);
  message.map_from_camera(messages::to_pose_message(result.map_from_camera));
  message.reference_from_camera(messages::to_pose_message(result.reference_from_camera));
  message.extract_us(static_cast<std::uint32_t>(result.times.extract_us));
  message.predict_us(report.predict_us);
  message.track_us(static_cast<std::uint32_t>(result.times.track_us));
  message.total_us(report.total_us);
  message.frames_dropped(report.frames_dropped);
  message.box_sets_used(report.box_sets_used);
  state_.write(message);
}

std::uint64_t TrackerOutputs::publish_poses(std::span<const KeyframePose> poses, const LoopState& loops,
                                            bool exact) {
  rds_msgs::msg::KeyFramePoses message;
  message.header(messages::make_header(poses.empty() ? 0 : poses.back().stamp_ns, kMap));
  message.instance(instance_);
  message.map_epoch(map_epoch_);
  message.source(0);
  message.loop_instance(loops.instance);
  message.loop_revision(loops.revision);
  message.loops_closed(loops.loops_closed);
  if (!poses.empty()) message.answered_keyframe_id(poses.back().id);
  const bool somebody_new = has_new_reader() || std::exchange(reader_waits_, false);
  messages::append_poses(pose_changes_.next(poses, somebody_new || exact, message), message);
  keyframe_poses_.write(message);
  return pose_changes_.revision();
}

}  // namespace rds::tracker
