// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/geometry/camera_model.hpp"
#include "common/geometry/keyframe_pose.hpp"
#include "common/messages/conversions.hpp"
#include "nav_msgs/msg/OccupancyGrid.h"
#include "rds_msgs/msg/CommandResult.h"
#include "rds_msgs/msg/FrameFeatures.h"
#include "rds_msgs/msg/PredictedBoxes.h"
#include "rds_msgs/msg/TrackingState.h"
#include "services/viewer/core/frames/frame.hpp"
#include "vision_msgs/msg/Detection3DArray.h"

/// Messages as frames; an error says what is wrong with a message that nobody can draw.
namespace rds::viewer {

using messages::Expected;

/// @param in_submap  the camera's pose there, in place of that in the map.
Expected<Bytes> tracking_frame(const rds_msgs::msg::TrackingState& state,
                               const std::optional<geometry::Pose>& in_submap = std::nullopt);
Expected<Bytes> boxes_frame(const rds_msgs::msg::PredictedBoxes& boxes);
Expected<Bytes> objects_frame(const vision_msgs::msg::Detection3DArray& objects);
Expected<Bytes> grid_frame(const nav_msgs::msg::OccupancyGrid& grid);

/// Ids of two keyframes that a loop was closed between, the later one first.
using Loop = std::array<std::uint64_t, 2>;
/// @param kind  of keyframes, or of those of a submap, which has no loops.
Bytes keyframes_frame(Kind kind, std::span<const geometry::KeyframePose> keyframes,
                      std::span<const Loop> loops);

Bytes camera_frame(const geometry::CameraModel& camera);
/// @param labels  the map's label table; index 0 is "".
Bytes labels_frame(std::span<const std::string> labels);
Bytes reply_frame(const std::string& verb, const rds_msgs::msg::CommandResult& result);

/// @param jpeg  a picture of this size. @param features  of the same stamp; nullptr: none are known.
Expected<Bytes> picture_frame(std::span<const std::uint8_t> jpeg, std::int64_t stamp_ns, std::uint32_t width,
                              std::uint32_t height, const rds_msgs::msg::FrameFeatures* features);

}  // namespace rds::viewer
