// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/stream.hpp"

#include <opencv2/imgcodecs.hpp>

#include "common/bus/type_ops.hpp"
#include "common/image/picture_file.hpp"
#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"
#include "sensor_msgs/msg/CompressedImage.h"
#include "sensor_msgs/msg/Image.h"

namespace rds::recording {
namespace {

using sensor_msgs::msg::CompressedImage;
using sensor_msgs::msg::Image;

constexpr std::size_t kDepthHeaderBytes =
    12;  // of compressed_depth_image_transport: format and two parameters
constexpr float kMillimetre = 0.001F;

template <class Message>
std::shared_ptr<Message> decode(std::span<const std::uint8_t> data) {
  auto message = std::make_shared<Message>();
  if (!bus::type_ops<Message>().decode(data.data(), data.size(), message.get())) return nullptr;
  return message;
}

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

/// Decodes a picture that a message carries. @return empty if it is none, or torn.
cv::Mat unpack(std::span<const std::uint8_t> bytes, int flags) {
  if (bytes.empty() || !image::is_whole_picture(bytes)) return {};
  try {
    const cv::Mat1b view(1, static_cast<int>(bytes.size()), const_cast<std::uint8_t*>(bytes.data()));
    return cv::imdecode(view, flags | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    return {};
  }
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
                       messages::to_nanoseconds(message->header().stamp())};
  }
  const auto message = decode<CompressedImage>(data);
  if (!message) return std::nullopt;
  PictureHead head = compressed_head(message->format());
  head.stamp_ns = messages::to_nanoseconds(message->header().stamp());
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
  cv::Mat pixels = unpack(compressed->data(), cv::IMREAD_COLOR);
  if (pixels.empty()) return tl::unexpected<std::string>("a picture that is torn, or neither JPEG nor PNG");
  return image::ColorImage{std::move(pixels), image::ChannelOrder::kBgr, nullptr};
}

tl::expected<image::DepthImage, std::string> decode_depth(Packing packing, const Bytes& message) {
  if (packing == Packing::kRaw) {
    auto raw = decode<Image>(message);
    if (!raw) return undecodable();
    return messages::to_depth_image(std::move(raw));
  }
  const auto compressed = decode<CompressedImage>(message);
  if (!compressed) return undecodable();
  std::span<const std::uint8_t> bytes = compressed->data();
  if (packing == Packing::kCompressedDepth) bytes = bytes.subspan(std::min(bytes.size(), kDepthHeaderBytes));
  cv::Mat values = unpack(bytes, cv::IMREAD_UNCHANGED);
  if (values.type() != CV_16UC1 || compressed->format().starts_with("32FC1"))
    return tl::unexpected<std::string>("compressed depth that is no whole PNG of 16 bits in millimetres");
  return image::DepthImage{std::move(values), kMillimetre, nullptr};
}

}  // namespace rds::recording
