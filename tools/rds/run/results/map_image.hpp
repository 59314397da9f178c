// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "common/geometry/trajectory.hpp"

namespace rds::run {

/// Draws map.png from map.ot and objects.json of a run's folder.
///
/// @param description  the mapper's answer to `finish`: JSON with "up" (against gravity) and "labels".
/// @throws std::runtime_error naming the file that cannot be read or written.
void write_map_image(const std::filesystem::path& folder, const std::string& description,
                     std::span<const geometry::StampedPose> trajectory);

}  // namespace rds::run
