// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/image/rgbd_frame.hpp"
#include "common/messages/conversions.hpp"
#include "sensor_msgs/msg/CompressedImage.h"
#include "sensor_msgs/msg/Image.h"

/// Pictures as camera drivers send them. (Those of keyframes are rgb8, bgr8, 16UC1 or 32FC1:
/// image_conversions.hpp.)
namespace rds::messages {

/// The picture of a message in any of image::color_encodings(). Of rgb8 and bgr8 without a copy, as
/// to_color_image(); others are converted to BGR.
/// @return or what is wrong with encoding, size, step or data.
Expected<image::ColorImage> camera_color(std::shared_ptr<const sensor_msgs::msg::Image> message);
/// As to_depth_image(); big-endian values are copied.
Expected<image::DepthImage> camera_depth(std::shared_ptr<const sensor_msgs::msg::Image> message);

/// The picture of compressed_image_transport: JPEG or PNG, whatever its format says.
/// @return or what is wrong: torn, or neither of the two.
Expected<image::ColorImage> camera_color(const sensor_msgs::msg::CompressedImage& message);
/// The depth of compressed_depth_image_transport ("16UC1; compressedDepth png": 12 bytes, then a PNG;
/// "16UC1; compressedDepth rvl": 12 bytes, columns, rows, then RVL; of "32FC1; …" it is inverse depth), or of
/// compressed_image_transport (a PNG of 16 bits).
/// @return or what is wrong.
Expected<image::DepthImage> camera_depth(const sensor_msgs::msg::CompressedImage& message);

}  // namespace rds::messages
