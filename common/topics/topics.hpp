// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tuple>

#include "common/topics/topic.hpp"

namespace diagnostic_msgs::msg {
class DiagnosticArray;
}
namespace geometry_msgs::msg {
class PoseWithCovarianceStamped;
}
namespace map_msgs::msg {
class OccupancyGridUpdate;
}
namespace nav_msgs::msg {
class OccupancyGrid;
class Odometry;
class Path;
}  // namespace nav_msgs::msg
namespace octomap_msgs::msg {
class Octomap;
}
namespace rds_msgs::msg {
class Command;
class CommandResult;
class FrameFeatures;
class KeyFrameFeatures;
class KeyFrameImages;
class KeyFramePoses;
class MapInfo;
class OctreeDelta;
class PredictedBoxes;
class ServiceStatus;
class TrackingState;
class TransferChunk;
class TransferOffer;
class TransferRequest;
}  // namespace rds_msgs::msg
namespace sensor_msgs::msg {
class CameraInfo;
class CompressedImage;
class Image;
class Imu;
class PointCloud2;
}  // namespace sensor_msgs::msg
namespace tf2_msgs::msg {
class TFMessage;
}
namespace vision_msgs::msg {
class Detection2DArray;
class Detection3DArray;
}  // namespace vision_msgs::msg
namespace visualization_msgs::msg {
class MarkerArray;
}

/// The table of topics: every endpoint of this project comes from here, and so do the links that `rds run`
/// waits for and the permissions of `rds secure`. Tests compare the READMEs with it.
namespace rds::topics {

// The camera. Names where the settings say no others (tracker: camera, transformer: camera_info_topic).
inline constexpr Topic<sensor_msgs::msg::Image> kColor{
    "camera/color/image_raw",
    {{kPlayer, bus::kSensor}},
    {{kTracker, bus::kSensor}, {kViewer, bus::kSensorBestEffort}}};
inline constexpr Topic<sensor_msgs::msg::CameraInfo> kCameraInfo{
    "camera/color/camera_info",
    {{kPlayer, bus::kSensor}},
    {{kTracker | kTransformer, bus::kSensor}, {kViewer, bus::kSensorBestEffort}}};
inline constexpr Topic<sensor_msgs::msg::Image> kDepth{
    "camera/aligned_depth_to_color/image_raw", {{kPlayer, bus::kSensor}}, {{kTracker, bus::kSensor}}};

// What a driver may offer beside them, or in their place: beside another name stand others.
inline constexpr Topic<sensor_msgs::msg::CompressedImage> kColorCompressed{
    "camera/color/image_raw/compressed", {}, {{kTracker, bus::kSensor}}};
inline constexpr Topic<sensor_msgs::msg::CompressedImage> kDepthCompressed{
    "camera/aligned_depth_to_color/image_raw/compressedDepth", {}, {{kTracker, bus::kSensor}}};
inline constexpr Topic<sensor_msgs::msg::CameraInfo> kDepthInfo{
    "camera/aligned_depth_to_color/camera_info", {}, {{kTracker, bus::kSensor}}};

// What else a robot may sense. Names as robots have them; the tracker reads what its settings name (tracker:
// inputs).
// Motion: small messages, up to some hundred a second, each of which counts.
inline constexpr bus::Qos kMotion{.reliable = true, .depth = 500, .follows_publishers = true};
inline constexpr Topic<nav_msgs::msg::Odometry> kRobotOdometry{
    "odom", {{kPlayer, kMotion}}, {{kTracker, kMotion}}};
inline constexpr Topic<sensor_msgs::msg::Imu> kImu{"imu", {{kPlayer, kMotion}}, {{kTracker, kMotion}}};
inline constexpr Topic<geometry_msgs::msg::PoseWithCovarianceStamped> kInitialPose{
    "initialpose", {}, {{kTracker, bus::kStream}}};

// Each frame.
inline constexpr Topic<nav_msgs::msg::Odometry> kOdometry{"rds/odometry", {{kTracker, bus::kStream}}, {}};
inline constexpr Topic<tf2_msgs::msg::TFMessage> kTransforms{
    "tf", {{kTracker, bus::kTransform}}, {{kTracker, bus::kTransform}}, true};
inline constexpr Topic<tf2_msgs::msg::TFMessage> kStaticTransforms{
    "tf_static", {{kPlayer, bus::kLatched}}, {{kTracker, bus::kLatchedEvery}}, true};
inline constexpr Topic<rds_msgs::msg::TrackingState> kTrackingState{
    "rds/tracking_state", {{kTracker, bus::kStream}}, {{kPlayer | kViewer, bus::kStream}}};
inline constexpr Topic<rds_msgs::msg::PredictedBoxes> kPredictedBoxes{
    "rds/predicted_boxes", {{kTracker, bus::kStream}}, {{kPlayer | kViewer, bus::kStream}}};
inline constexpr Topic<sensor_msgs::msg::PointCloud2> kObstacles{
    "rds/obstacles", {{kTracker, bus::kStream}}, {}};
inline constexpr Topic<rds_msgs::msg::FrameFeatures> kFeatures{
    "rds/features", {{kTracker, bus::kStream}}, {{kPlayer | kViewer, bus::kStream}}};

// Each keyframe.
inline constexpr Topic<rds_msgs::msg::KeyFrameImages> kKeyframeImages{
    "rds/keyframe/images", {{kTracker, bus::kKeyframeImages}}, {{kDetector | kMapper, bus::kKeyframeImages}}};
inline constexpr Topic<rds_msgs::msg::KeyFrameFeatures> kKeyframeFeatures{
    "rds/keyframe/features", {{kTracker, bus::kKeyframeFeatures}}, {{kLoopCloser, bus::kKeyframeFeatures}}};
inline constexpr Topic<rds_msgs::msg::KeyFramePoses> kKeyframePoses{
    "rds/keyframe/poses",
    {{kTracker, bus::kPoses}, {kLoopCloser, bus::kLatched}},
    {{kTracker | kTransformer | kMapper | kPlayer | kViewer, bus::kLatchedEvery}}};
inline constexpr Topic<nav_msgs::msg::Path> kTrajectory{"rds/trajectory", {{kTracker, bus::kLatched}}, {}};
inline constexpr Topic<vision_msgs::msg::Detection2DArray> kDetections{
    "rds/detections", {{kDetector, bus::kStream}}, {{kTransformer | kPlayer, bus::kStream}}};
inline constexpr Topic<vision_msgs::msg::Detection3DArray> kBoxes{
    "rds/boxes",
    {{kTransformer, bus::kBoxes}},
    {{kTracker, bus::kStream}, {kMapper, bus::kBoxes}}};  // old boxes are of no use to a tracker

// The map.
inline constexpr Topic<rds_msgs::msg::OctreeDelta> kMapDelta{
    "rds/map/delta", {{kMapper, bus::kDelta}}, {{kTool | kViewer, bus::kDelta}}};
inline constexpr Topic<octomap_msgs::msg::Octomap> kMapFull{
    "rds/map/full", {{kMapper, bus::kLatchedLarge}}, {{kTool | kViewer, bus::kLatched}}};
inline constexpr Topic<octomap_msgs::msg::Octomap> kMapBinary{
    "rds/map/binary", {{kMapper, bus::kLatchedLarge}}, {}};
inline constexpr Topic<sensor_msgs::msg::PointCloud2> kMapPoints{
    "rds/map/points", {{kMapper, bus::kLatchedLarge}}, {}};
inline constexpr Topic<rds_msgs::msg::MapInfo> kMapInfo{
    "rds/map/info",
    {{kMapper, bus::kLatchedEvery}},
    {{kPlayer, bus::kLatched}, {kTool | kViewer, bus::kLatchedEvery}}};
inline constexpr Topic<vision_msgs::msg::Detection3DArray> kMapObjects{
    "rds/map/objects", {{kMapper, bus::kLatched}}, {{kViewer, bus::kLatched}}};
inline constexpr Topic<visualization_msgs::msg::MarkerArray> kMapMarkers{
    "rds/map/markers", {{kMapper, bus::kLatched}}, {}};
inline constexpr Topic<nav_msgs::msg::OccupancyGrid> kMapGrid{
    "rds/map/grid", {{kMapper, bus::kLatched}}, {{kViewer, bus::kLatched}}};
inline constexpr Topic<map_msgs::msg::OccupancyGridUpdate> kMapGridUpdates{
    "rds/map/grid_updates", {{kMapper, bus::kStream}}, {}};

// To readers on other machines, in place of the topics of keyframes (common/transfer).
inline constexpr const char* kTransferPrefix = "rds/transfer/";
inline constexpr Process kFarReaders = kDetector | kMapper | kLoopCloser;
inline constexpr Topic<rds_msgs::msg::TransferOffer> kTransferOffers{
    "rds/transfer/offers", {{kTracker, bus::kLatched}}, {{kFarReaders, bus::kLatched}}};
inline constexpr Topic<rds_msgs::msg::TransferRequest> kTransferRequests{
    "rds/transfer/requests", {{kFarReaders, bus::kDatagrams}}, {{kTracker, bus::kDatagrams}}};
inline constexpr Topic<rds_msgs::msg::TransferChunk> kTransferToDetector{
    "rds/transfer/detector", {{kTracker, bus::kDatagrams}}, {{kDetector, bus::kDatagrams}}};
inline constexpr Topic<rds_msgs::msg::TransferChunk> kTransferToMapper{
    "rds/transfer/mapper", {{kTracker, bus::kDatagrams}}, {{kMapper, bus::kDatagrams}}};
inline constexpr Topic<rds_msgs::msg::TransferChunk> kTransferToLoopCloser{
    "rds/transfer/loop_closer", {{kTracker, bus::kDatagrams}}, {{kLoopCloser, bus::kDatagrams}}};
// To readers of the map on other machines, in place of rds/map/full, rds/map/info and rds/map/delta.
inline constexpr Topic<rds_msgs::msg::TransferOffer> kMapOffers{
    "rds/map/offers", {{kMapper, bus::kLatched}}, {{kTool | kViewer, bus::kLatched}}};
inline constexpr Topic<rds_msgs::msg::TransferRequest> kMapRequests{
    "rds/map/requests", {{kTool | kViewer, bus::kDatagrams}}, {{kMapper, bus::kDatagrams}}};
/// Each reader has one of its own: this name, a slash and the reader's instance.
inline constexpr Topic<rds_msgs::msg::TransferChunk> kMapChunks{
    "rds/map/chunks", {{kMapper, bus::kDatagrams}}, {{kTool | kViewer, bus::kDatagrams}}};
/// The one that a reader hears alone, so that none has to take what another one asks for.
inline const Topic<rds_msgs::msg::TransferChunk>& transfer_to(Process reader) {
  return reader == kTool       ? kMapChunks
         : reader == kDetector ? kTransferToDetector
         : reader == kMapper   ? kTransferToMapper
                               : kTransferToLoopCloser;
}

// A run on several machines: between rds run where the camera is and rds run on each of the others.
inline constexpr Topic<rds_msgs::msg::Command> kRunRequest{
    "rds/run/request", {{kPlayer, bus::kCommand}}, {{kFarRun, bus::kCommand}}};
inline constexpr Topic<rds_msgs::msg::CommandResult> kRunReply{
    "rds/run/reply", {{kFarRun, bus::kCommand}}, {{kPlayer, bus::kCommand}}};

// Every service.
inline constexpr Topic<rds_msgs::msg::Command> kCommand{
    "rds/command", {{kPlayer | kTool | kViewer, bus::kCommand}}, {{kServices | kViewer, bus::kCommand}}};
inline constexpr Topic<rds_msgs::msg::CommandResult> kCommandResult{
    "rds/command_result",
    {{kServices | kViewer, bus::kCommand}},
    {{kPlayer | kTool | kViewer, bus::kCommand}}};
inline constexpr Topic<rds_msgs::msg::ServiceStatus> kServiceStatus{
    "rds/services",
    {{kServices | kViewer, bus::kLatched}},
    {{kServices | kPlayer | kViewer, bus::kLatchedOfEach},
     {kTool, bus::kStream}}};  // rds status: what is said now
inline constexpr Topic<diagnostic_msgs::msg::DiagnosticArray> kDiagnostics{
    "diagnostics", {{kServices | kViewer, bus::kStream}}, {{kViewer, bus::kStream}}, true};

inline constexpr std::tuple kAllTopics{kColor,
                                       kCameraInfo,
                                       kDepth,
                                       kColorCompressed,
                                       kDepthCompressed,
                                       kDepthInfo,
                                       kRobotOdometry,
                                       kImu,
                                       kInitialPose,
                                       kOdometry,
                                       kTransforms,
                                       kStaticTransforms,
                                       kTrackingState,
                                       kPredictedBoxes,
                                       kObstacles,
                                       kFeatures,
                                       kKeyframeImages,
                                       kKeyframeFeatures,
                                       kKeyframePoses,
                                       kTrajectory,
                                       kDetections,
                                       kBoxes,
                                       kMapDelta,
                                       kMapFull,
                                       kMapBinary,
                                       kMapPoints,
                                       kMapInfo,
                                       kMapObjects,
                                       kMapMarkers,
                                       kMapGrid,
                                       kMapGridUpdates,
                                       kTransferOffers,
                                       kTransferRequests,
                                       kTransferToDetector,
                                       kTransferToMapper,
                                       kTransferToLoopCloser,
                                       kRunRequest,
                                       kRunReply,
                                       kMapOffers,
                                       kMapRequests,
                                       kMapChunks,
                                       kCommand,
                                       kCommandResult,
                                       kServiceStatus,
                                       kDiagnostics};

}  // namespace rds::topics
