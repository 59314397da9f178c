// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "common/geometry/camera_model.hpp"

namespace rds::image {

/// What a dataset's camera.yaml says.
struct CameraDescription {
  geometry::CameraModel camera;
  double depth_scale = 0;  // raw depth units per metre
  double fps = 30;         // nominal frame rate [1/s]
};

/// Reads camera.yaml: width, height, fx, fy, cx, cy, distortion (5 numbers k1 k2 p1 p2 k3), depth_scale; fps
/// may be left out. An unknown or missing key, or a value out of range, is an error.
///
/// @return or one sentence per violation, each naming the file, the key and what was expected.
tl::expected<CameraDescription, std::string> read_camera_yaml(const std::filesystem::path& file);

/// The published intrinsics of the camera that a folder's name mentions: of TUM RGB-D ("freiburg1",
/// "freiburg2", "freiburg3") or of Bonn RGB-D Dynamic ("rgbd_bonn").
std::optional<CameraDescription> known_camera_of_folder(const std::string& folder_name);

}  // namespace rds::image
