// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <opencv2/core.hpp>

#include "common/image/rgbd_frame.hpp"
#include "common/messages/conversions.hpp"
#include "sensor_msgs/msg/Image.h"

namespace rds::messages {

/// The pixels as a matrix of this type of OpenCV over the message's memory. OpenCV has no matrix over const
/// memory; it is to be read only.
/// @return an error naming what is wrong with size (at most 16384 px a side), step or data.
Expected<cv::Mat> pixels_of(const sensor_msgs::msg::Image& message, int type);

/// The picture of an rgb8 or bgr8 message, without a copy: the pixels lie in the message, which lives as long
/// as the picture does. To read a picture inside a larger message pass std::shared_ptr<const Image>(whole,
/// &whole->color()).
///
/// @return an error naming what is wrong with encoding, size (at most 16384 px a side), step or data.
Expected<image::ColorImage> to_color_image(std::shared_ptr<const sensor_msgs::msg::Image> message);

/// As to_color_image(), for 16UC1 or mono16 (millimetres) and 32FC1 (metres), little-endian.
Expected<image::DepthImage> to_depth_image(std::shared_ptr<const sensor_msgs::msg::Image> message);

/// The mono8 mask of a picture's square cells, copied; empty if the message has no pixels.
/// @return or what is wrong: as above, or a number of cells that cannot cover the picture.
Expected<cv::Mat1b> to_cell_mask(const sensor_msgs::msg::Image& message, cv::Size picture);

/// Copies the pixels; encoding bgr8 or rgb8 as their order says.
/// @throws std::invalid_argument unless they are CV_8UC3.
sensor_msgs::msg::Image to_image_message(const image::ColorImage& image, std_msgs::msg::Header header);

/// Copies the values; encoding 16UC1 (millimetres) or 32FC1 (metres). ROS knows no other depth units: values
/// in other units are scaled, 16-bit ones rounded and saturated.
/// @throws std::invalid_argument unless they are CV_16UC1 or CV_32FC1.
sensor_msgs::msg::Image to_image_message(const image::DepthImage& image, std_msgs::msg::Header header);

/// Encoding mono8. An empty mask gives a message without pixels.
sensor_msgs::msg::Image to_image_message(const cv::Mat1b& mask, std_msgs::msg::Header header);

}  // namespace rds::messages
