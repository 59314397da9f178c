// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>

#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// Unit vector of "x", "-x", … "-z". @throws std::invalid_argument for another word.
Eigen::Vector3d axis_of(const std::string& name);

/// Estimates the direction against gravity from what the keyframes see.
///
/// A handheld or mounted camera is roughly upright: the mean of −y of the cameras is a first guess. Surface
/// normals within 40° of it (floor, table tops, and ceilings seen from below) vote; the densest 5° cone wins
/// and is refined to its mean. Without enough such normals the first guess stands.
/// @param poses      of the keyframes: map_from_camera.
/// @param record_of  the keyframe with that index and its pose; nullopt if it cannot be had. Asked for a few
/// only.
/// @return unit vector in the map frame; (0, −1, 0) without keyframes.
Eigen::Vector3d estimate_up(std::span<const geometry::Pose> poses,
                            const std::function<std::optional<KeyframeRecord>(std::size_t)>& record_of);

}  // namespace rds::mapper
