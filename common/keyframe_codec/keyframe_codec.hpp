// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <tl/expected.hpp>

#include "common/keyframe_codec/jpeg_codec.hpp"
#include "common/keyframe_codec/lossless_codec.hpp"
#include "rds_msgs/msg/KeyFrameCompressed.h"
#include "rds_msgs/msg/KeyFrameImages.h"

namespace rds::keyframe_codec {

constexpr std::uint32_t kLargestPicture_px = 16 * 1024 * 1024;

/// Makes a keyframe small: colour as JPEG, depth and mask without loss. The same keyframe gives the same
/// bytes, whatever was compressed before. Not thread-safe: one object per thread, which keeps its buffers.
class KeyframeCompressor {
 public:
  KeyframeCompressor();

  /// @return or what is wrong with a picture, beginning with its name: encoding, size, step, data as in
  /// common/messages/image_conversions.hpp, more than kLargestPicture_px.
  tl::expected<rds_msgs::msg::KeyFrameCompressed, std::string> compress(
      const rds_msgs::msg::KeyFrameImages& keyframe);

 private:
  JpegCompressor jpeg_;
  LosslessCompressor lossless_;
};

/// Makes pictures of it again, whoever sent it. Not thread-safe: one object per thread.
class KeyframeDecompressor {
 public:
  /// Rows have no padding; depth and mask are those of the compressed keyframe to the bit.
  ///
  /// @return or a fixed sentence, beginning with the picture's name: format or encoding not known, more than
  /// kLargestPicture_px, data that is damaged or torn, of another size than declared, or needs more memory
  /// than that size. Nothing is decoded beyond the declared size.
  tl::expected<rds_msgs::msg::KeyFrameImages, std::string> decompress(
      const rds_msgs::msg::KeyFrameCompressed& keyframe);

 private:
  LosslessDecompressor lossless_;
};

}  // namespace rds::keyframe_codec
