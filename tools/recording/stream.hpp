// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "common/image/rgbd_frame.hpp"
#include "tools/recording/bag/bag.hpp"

namespace rds::recording {

/// How a topic's pictures are packed.
enum class Packing {
  kRaw,              // sensor_msgs/msg/Image
  kCompressed,       // sensor_msgs/msg/CompressedImage: JPEG or PNG
  kCompressedDepth,  // the same, or RVL, with 12 bytes before it, as compressed_depth_image_transport writes
                     // it
};

enum class Content { kColor, kDepth };

/// A message with a picture, without its pixels.
struct PictureHead {
  Packing packing = Packing::kRaw;
  Content content = Content::kColor;
  double depth_scale = 1000;  // units per metre
  std::int64_t stamp_ns = 0;
  std::string frame = {};  // header.frame_id
};

/// Looks at a message of one of the two picture types.
/// @return nullopt if it cannot be decoded, or holds what is neither colour (rgb8, bgr8, JPEG, PNG) nor depth
/// (16UC1, mono16, 32FC1).
std::optional<PictureHead> picture_head(const BagTopic& topic, std::span<const std::uint8_t> data);

/// The pictures of one topic, by stamp.
struct Stream {
  struct Entry {
    std::int64_t stamp_ns;
    BagPlace place;
  };
  std::string topic;
  Packing packing = Packing::kRaw;
  Content content = Content::kColor;
  double depth_scale = 1000;
  std::string frame = {};  // header.frame_id of the first
  std::vector<Entry> entries = {};
};

/// Decode a message's picture. @return or what is wrong, in words that can follow "TOPIC: ".
tl::expected<image::ColorImage, std::string> decode_color(Packing packing, const Bytes& message);
tl::expected<image::DepthImage, std::string> decode_depth(Packing packing, const Bytes& message);

inline const std::string kImageType = "sensor_msgs/msg/Image";
inline const std::string kCompressedImageType = "sensor_msgs/msg/CompressedImage";

}  // namespace rds::recording
