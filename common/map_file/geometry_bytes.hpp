// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

#include "common/geometry/camera_model.hpp"
#include "common/geometry/keyframe_pose.hpp"
#include "common/map_file/byte_reader.hpp"
#include "common/map_file/byte_writer.hpp"

namespace rds::map_file {

/// The same bits come back. Readers refuse what is not finite, poses that are not rigid and cameras that are
/// not valid.
void put(ByteWriter& writer, const Eigen::Vector3d& vector);
Eigen::Vector3d get_vector(ByteReader& reader);

void put(ByteWriter& writer, const geometry::Pose& pose);
geometry::Pose get_pose(ByteReader& reader);

void put(ByteWriter& writer, const geometry::CameraModel& camera);
geometry::CameraModel get_camera(ByteReader& reader);

/// Section `keyframe_poses`: every keyframe of a map, by ascending id.
Bytes to_bytes(std::span<const geometry::KeyframePose> poses);
tl::expected<std::vector<geometry::KeyframePose>, std::string> keyframe_poses_from_bytes(
    std::span<const std::uint8_t> bytes);

}  // namespace rds::map_file
