// SPDX-License-Identifier: Apache-2.0
#include "common/messages/image_conversions.hpp"

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "common/image/cell_mask.hpp"

namespace rds::messages {
namespace {

using sensor_msgs::msg::Image;

constexpr std::uint32_t kLargestSide = 16384;
constexpr float kMillimetre = 0.001F;
constexpr float kMetre = 1.0F;

Image message_of(const cv::Mat& pixels, const char* encoding, std_msgs::msg::Header header) {
  Image message;
  message.header(std::move(header));
  message.width(static_cast<std::uint32_t>(pixels.cols));
  message.height(static_cast<std::uint32_t>(pixels.rows));
  message.encoding(encoding);
  message.is_bigendian(0);
  const std::size_t row_size = static_cast<std::size_t>(pixels.cols) * pixels.elemSize();
  message.step(static_cast<std::uint32_t>(row_size));
  auto& data = message.data();
  if (pixels.isContinuous()) {
    data.assign(pixels.datastart, pixels.datastart + row_size * static_cast<std::size_t>(pixels.rows));
    return message;
  }
  data.reserve(row_size * static_cast<std::size_t>(pixels.rows));
  for (int y = 0; y < pixels.rows; ++y) data.insert(data.end(), pixels.ptr(y), pixels.ptr(y) + row_size);
  return message;
}

}  // namespace

Expected<cv::Mat> pixels_of(const Image& message, int type) {
  const std::uint32_t width = message.width();
  const std::uint32_t height = message.height();
  if (width == 0 || height == 0 || width > kLargestSide || height > kLargestSide) {
    return tl::make_unexpected("image of " + std::to_string(width) + " x " + std::to_string(height) +
                               " px, expected 1 to 16384 a side");
  }
  const std::size_t row_size = width * CV_ELEM_SIZE(type);
  if (message.step() < row_size || message.step() % CV_ELEM_SIZE1(type) != 0) {
    return tl::make_unexpected("image row of " + std::to_string(message.step()) +
                               " bytes, expected at least " + std::to_string(row_size));
  }
  const std::size_t size = std::size_t{message.step()} * (height - 1) + row_size;
  if (message.data().size() < size) {
    return tl::make_unexpected("image data of " + std::to_string(message.data().size()) +
                               " bytes, expected at least " + std::to_string(size));
  }
  auto* data = const_cast<std::uint8_t*>(message.data().data());
  return cv::Mat(static_cast<int>(height), static_cast<int>(width), type, data, message.step());
}

Expected<image::ColorImage> to_color_image(std::shared_ptr<const Image> message) {
  const std::string& encoding = message->encoding();
  if (encoding != "rgb8" && encoding != "bgr8") {
    return tl::make_unexpected("image encoding '" + encoding + "', expected rgb8 or bgr8");
  }
  auto pixels = pixels_of(*message, CV_8UC3);
  if (!pixels) return tl::make_unexpected(pixels.error());
  const auto order = encoding == "rgb8" ? image::ChannelOrder::kRgb : image::ChannelOrder::kBgr;
  return image::ColorImage{*pixels, order, std::move(message)};
}

Expected<image::DepthImage> to_depth_image(std::shared_ptr<const Image> message) {
  const std::string& encoding = message->encoding();
  const bool millimetres = encoding == "16UC1" || encoding == "mono16";
  if (!millimetres && encoding != "32FC1") {
    return tl::make_unexpected("depth encoding '" + encoding + "', expected 16UC1 (mm) or 32FC1 (m)");
  }
  if (message->is_bigendian() != 0)
    return tl::make_unexpected("depth image is big-endian, expected little-endian");
  auto values = pixels_of(*message, millimetres ? CV_16UC1 : CV_32FC1);
  if (!values) return tl::make_unexpected(values.error());
  return image::DepthImage{*values, millimetres ? kMillimetre : kMetre, std::move(message)};
}

Expected<cv::Mat1b> to_cell_mask(const Image& message, cv::Size picture) {
  if (message.width() == 0 && message.height() == 0 && message.data().empty()) return cv::Mat1b();
  if (message.encoding() != "mono8")
    return tl::make_unexpected("mask encoding '" + message.encoding() + "', expected mono8");
  const auto cells = pixels_of(message, CV_8UC1);
  if (!cells) return tl::make_unexpected(cells.error());
  if (image::cell_side_px(picture, cells->size()) == 0) {
    return tl::make_unexpected("mask of " + std::to_string(cells->cols) + " x " +
                               std::to_string(cells->rows) +
                               " cells, expected square cells that cover the picture");
  }
  return cv::Mat1b(cells->clone());
}

Image to_image_message(const image::ColorImage& image, std_msgs::msg::Header header) {
  if (image.pixels.type() != CV_8UC3) throw std::invalid_argument("a colour image must be CV_8UC3");
  return message_of(image.pixels, image.order == image::ChannelOrder::kRgb ? "rgb8" : "bgr8",
                    std::move(header));
}

Image to_image_message(const image::DepthImage& image, std_msgs::msg::Header header) {
  const int type = image.values.type();
  if (type != CV_16UC1 && type != CV_32FC1)
    throw std::invalid_argument("a depth image must be CV_16UC1 or CV_32FC1");
  const float unit = type == CV_16UC1 ? kMillimetre : kMetre;
  const char* encoding = type == CV_16UC1 ? "16UC1" : "32FC1";
  if (std::abs(image.metres_per_unit - unit) < 1e-9F)
    return message_of(image.values, encoding, std::move(header));
  cv::Mat scaled;
  image.values.convertTo(scaled, type,
                         static_cast<double>(image.metres_per_unit) / static_cast<double>(unit));
  return message_of(scaled, encoding, std::move(header));
}

Image to_image_message(const cv::Mat1b& mask, std_msgs::msg::Header header) {
  return message_of(mask, "mono8", std::move(header));
}

}  // namespace rds::messages
