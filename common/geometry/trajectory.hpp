// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "common/geometry/pose.hpp"

namespace rds::geometry {

struct StampedPose {
  std::int64_t stamp_ns = 0;
  Pose map_from_camera = Pose::Identity();
  std::string stamp_text;  // the digits the stamp was read from; empty: format_stamp() writes it
};

/// Reads a TUM trajectory, `timestamp tx ty tz qx qy qz qw` per line, `#` comments, spaces or commas between
/// numbers.
///
/// @return poses in the file's order (stamps never decrease), or one sentence that names file, line and
/// expectation.
tl::expected<std::vector<StampedPose>, std::string> read_trajectory(const std::filesystem::path& file);

/// One line of a TUM trajectory without the newline: the stamp's own digits, the pose with nine decimals, qw
/// ≥ 0.
std::string trajectory_line(const StampedPose& pose);

/// Writes all poses, whole or not at all (a temporary file beside it is renamed).
///
/// @return or one sentence that names the file and what failed.
tl::expected<void, std::string> write_trajectory(const std::filesystem::path& file,
                                                 std::span<const StampedPose> poses);

/// Pose at a time: linear in translation, slerp in rotation; before the first and after the last pose, that
/// pose.
///
/// @param poses  ascending in time, at least one. @throws std::invalid_argument if empty.
Pose interpolate(std::span<const StampedPose> poses, std::int64_t stamp_ns);

/// Pose at a time, never further than the poses reach: the one with this stamp, or interpolated between two
/// neighbours at most `max_gap_ns` apart; otherwise nullopt.
///
/// @param poses  ascending in time.
std::optional<Pose> pose_at(std::span<const StampedPose> poses, std::int64_t stamp_ns,
                            std::int64_t max_gap_ns);

}  // namespace rds::geometry
