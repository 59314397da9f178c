// SPDX-License-Identifier: Apache-2.0
#include "common/messages/camera_conversions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <utility>

#include <opencv2/imgcodecs.hpp>

#include "common/image/color_encoding.hpp"
#include "common/image/picture_file.hpp"
#include "common/image/rvl.hpp"
#include "common/messages/image_conversions.hpp"

namespace rds::messages {
namespace {

using sensor_msgs::msg::CompressedImage;
using sensor_msgs::msg::Image;

constexpr std::size_t kDepthHeaderBytes = 12;  // of compressed_depth_image_transport: format, two parameters
constexpr float kMillimetre = 0.001F;
constexpr float kMetre = 1.0F;

/// More has no camera, and a few bytes could claim it.
constexpr std::int64_t kMostPixels = 50'000'000;
constexpr std::uint32_t kLongestSide = 65'535;

/// Decodes a picture that a message carries. @return empty if it is none, torn or too large.
cv::Mat unpack(std::span<const std::uint8_t> bytes, int flags) {
  const auto size = image::declared_size(bytes);
  const std::int64_t pixels = std::int64_t{size.width} * size.height;
  if (pixels == 0 || pixels > kMostPixels || !image::is_whole_picture(bytes)) return {};
  try {
    const cv::Mat1b view(1, static_cast<int>(bytes.size()), const_cast<std::uint8_t*>(bytes.data()));
    return cv::imdecode(view, flags | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    return {};
  }
}

/// Decodes depth as compressed_depth_image_transport sends it: columns and rows, then RVL. @return as
/// unpack().
cv::Mat unpack_rvl(std::span<const std::uint8_t> bytes) {
  std::array<std::uint32_t, 2> sides{};
  if (bytes.size() < sizeof sides) return {};
  std::memcpy(sides.data(), bytes.data(), sizeof sides);
  const auto [columns, rows] = sides;
  if (columns > kLongestSide || rows > kLongestSide || std::int64_t{columns} * rows > kMostPixels) return {};
  return image::decompress_rvl(bytes.subspan(sizeof sides),
                               {static_cast<int>(columns), static_cast<int>(rows)});
}

/// depth = A / (value − B), with A and B from the header; 0 is no measurement.
Expected<cv::Mat> depth_of_inverse(const cv::Mat& values, std::span<const std::uint8_t> header) {
  std::array<float, 2> parameters{};
  std::memcpy(parameters.data(), header.data() + 4, sizeof parameters);
  const auto [a, b] = parameters;
  if (!(std::isfinite(a) && std::isfinite(b) && a > 0))
    return tl::make_unexpected("compressed depth with parameters that are no numbers");
  cv::Mat1f depth(values.size(), 0.0F);
  for (int y = 0; y < values.rows; ++y)
    for (int x = 0; x < values.cols; ++x) {
      const float above = static_cast<float>(values.at<std::uint16_t>(y, x)) - b;
      if (values.at<std::uint16_t>(y, x) != 0 && above > 0) depth(y, x) = a / above;
    }
  return cv::Mat(depth);
}

}  // namespace

Expected<image::ColorImage> camera_color(std::shared_ptr<const Image> message) {
  const image::ColorEncoding* encoding = image::find_color_encoding(message->encoding());
  if (encoding == nullptr) {
    return tl::make_unexpected("image encoding '" + message->encoding() + "', expected one of " +
                               image::color_encodings());
  }
  if (!encoding->conversion) return to_color_image(std::move(message));
  const auto pixels = pixels_of(*message, encoding->type);
  if (!pixels) return tl::make_unexpected(pixels.error());
  if (encoding->needs_even_size && (pixels->cols % 2 != 0 || pixels->rows % 2 != 0)) {
    return tl::make_unexpected("image of " + std::to_string(pixels->cols) + " x " +
                               std::to_string(pixels->rows) + " px, expected even numbers for " +
                               message->encoding());
  }
  return image::ColorImage{image::to_bgr(*pixels, *encoding, message->is_bigendian() != 0),
                           image::ChannelOrder::kBgr, nullptr};
}

Expected<image::DepthImage> camera_depth(std::shared_ptr<const Image> message) {
  if (message->is_bigendian() == 0) return to_depth_image(std::move(message));
  auto native = std::make_shared<Image>();  // its header and pixels as to_depth_image() reads them
  native->width(message->width());
  native->height(message->height());
  native->encoding(message->encoding());
  native->step(message->step());
  native->data(message->data());
  const auto depth = to_depth_image(native);
  if (!depth) return depth;
  return image::DepthImage{image::swapped(depth->values), depth->metres_per_unit, nullptr};
}

Expected<image::ColorImage> camera_color(const CompressedImage& message) {
  cv::Mat pixels = unpack(message.data(), cv::IMREAD_COLOR);
  if (pixels.empty())
    return tl::make_unexpected("a picture that is torn, too large, or neither JPEG nor PNG");
  return image::ColorImage{std::move(pixels), image::ChannelOrder::kBgr, nullptr};
}

Expected<image::DepthImage> camera_depth(const CompressedImage& message) {
  const std::string& format = message.format();
  std::span<const std::uint8_t> bytes = message.data();
  const bool has_header = format.find("compressedDepth") != std::string::npos;
  const auto header = bytes.first(std::min(bytes.size(), has_header ? kDepthHeaderBytes : 0));
  const bool is_rvl = has_header && format.find("rvl") != std::string::npos;
  const auto packed = bytes.subspan(header.size());
  const cv::Mat values = is_rvl ? unpack_rvl(packed) : unpack(packed, cv::IMREAD_UNCHANGED);
  if (values.type() != CV_16UC1)
    return tl::make_unexpected("compressed depth ('" + format + "') that is no whole " +
                               (is_rvl ? "RVL of the size it declares" : "PNG of 16 bits"));
  if (!format.starts_with("32FC1")) return image::DepthImage{values, kMillimetre, nullptr};
  if (!has_header)
    return tl::make_unexpected("compressed depth ('" + format +
                               "'), expected millimetres in a PNG of 16 bits");
  auto depth = depth_of_inverse(values, header);
  if (!depth) return tl::make_unexpected(depth.error());
  return image::DepthImage{std::move(*depth), kMetre, nullptr};
}

}  // namespace rds::messages
