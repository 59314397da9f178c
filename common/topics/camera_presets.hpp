// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "common/config/config_reader.hpp"
#include "common/geometry/depth_noise.hpp"

namespace rds::topics {

/// Topics of an RGB-D camera as a driver for ROS 2 names them, where its launch file is given no other names,
/// and how well such a camera measures.
struct CameraPreset {
  const char* name;  // in settings
  const char* color;
  const char* camera_info;
  const char* depth;        // its camera_info stands beside it
  const char* depth_noise;  // of geometry::kDepthNoises
};

/// The first is the default: the names of this project (topics.hpp), and of realsense2_camera before 4.55.
/// Source: documentation and launch files of realsense2_camera, azure_kinect_ros_driver, orbbec_camera,
/// openni2_camera and freenect_camera.
inline constexpr std::array kCameraPresets{
    CameraPreset{"rds", "camera/color/image_raw", "camera/color/camera_info",
                 "camera/aligned_depth_to_color/image_raw", "kinect_v1"},
    CameraPreset{"realsense", "camera/camera/color/image_raw", "camera/camera/color/camera_info",
                 "camera/camera/aligned_depth_to_color/image_raw", "realsense"},
    CameraPreset{"azure_kinect", "rgb/image_raw", "rgb/camera_info", "depth_to_rgb/image_raw",
                 "azure_kinect"},
    CameraPreset{"orbbec", "camera/color/image_raw", "camera/color/camera_info", "camera/depth/image_raw",
                 "orbbec"},
    CameraPreset{"xtion", "camera/rgb/image_raw", "camera/rgb/camera_info", "camera/depth/image_raw",
                 "xtion"},
    CameraPreset{"kinect_v1", "camera/rgb/image_raw", "camera/rgb/camera_info",
                 "camera/depth_registered/image_raw", "kinect_v1"}};

/// The preset that a setting names; the default where it is absent or, which is a violation, names none.
CameraPreset read_camera_preset(config::ConfigReader& reader, const std::string& key);

/// A topic's setting: what it says goes before the preset, unless it is empty.
void read_topic(config::ConfigReader& reader, const std::string& key, const char* preset,
                std::string& target);

/// The name of a depth noise: what it says goes before the preset, unless it is empty. The preset's where it
/// names none, which is a violation.
geometry::DepthNoise read_depth_noise(config::ConfigReader& reader, const std::string& key,
                                      const CameraPreset& preset);

}  // namespace rds::topics
