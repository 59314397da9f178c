// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/stream.hpp"

#include "common/messages/camera_conversions.hpp"
#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"
#include "sensor_msgs/msg/CompressedImage.h"
#include "sensor_msgs/msg/Image.h"
#include "tools/recording/decode.hpp"

namespace rds::recording {
namespace {

using sensor_msgs::msg::CompressedImage;
using sensor_msgs::msg::Image;

std::optional<Content> content_of(const std::string& encoding) {
  if (encoding == "rgb8" || encoding == "bgr8") return Content::kColor;
  if (encoding == "16UC1" || encoding == "mono16" || encoding == "32FC1") return Content::kDepth;
  return std::nullopt;
}

/// Formats are "jpeg", "bgr8; jpeg compressed bgr8", "16UC1; compressedDepth png", "16UC1; png compressed".
PictureHead compressed_head(const std::string& format) {
  if (format.find("compressedDepth") != std::string::npos)
    return {Packing::kCompressedDepth, Content::kDepth};
  const std::string encoding = format.substr(0, format.find(';'));
  return {Packing::kCompressed, content_of(encoding).value_or(Content::kColor)};
}

tl::unexpected<std::string> undecodable() {
  return tl::unexpected<std::string>("a message that cannot be decoded");
}

}  // namespace

std::optional<PictureHead> picture_head(const BagTopic& topic, std::span<const std::uint8_t> data) {
  if (topic.type == kImageType) {
    const auto message = decode<Image>(data);
    const auto content = message ? content_of(message->encoding()) : std::nullopt;
    if (!content) return std::nullopt;
    return PictureHead{Packing::kRaw, *content, message->encoding() == "32FC1" ? 1.0 : 1000.0,
                       messages::to_nanoseconds(message->header().stamp()), message->header().frame_id()};
  }
  const auto message = decode<CompressedImage>(data);
  if (!message) return std::nullopt;
  PictureHead head = compressed_head(message->format());
  head.stamp_ns = messages::to_nanoseconds(message->header().stamp());
  head.frame = message->header().frame_id();
  return head;
}

tl::expected<image::ColorImage, std::string> decode_color(Packing packing, const Bytes& message) {
  if (packing == Packing::kRaw) {
    auto raw = decode<Image>(message);
    if (!raw) return undecodable();
    return messages::to_color_image(std::move(raw));
  }
  const auto compressed = decode<CompressedImage>(message);
  if (!compressed) return undecodable();
  return messages::camera_color(*compressed);
}

tl::expected<image::DepthImage, std::string> decode_depth(Packing packing, const Bytes& message) {
  if (packing == Packing::kRaw) {
    auto raw = decode<Image>(message);
    if (!raw) return undecodable();
    return messages::to_depth_image(std::move(raw));
  }
  const auto compressed = decode<CompressedImage>(message);
  if (!compressed) return undecodable();
  return messages::camera_depth(*compressed);
}

}  // namespace rds::recording
