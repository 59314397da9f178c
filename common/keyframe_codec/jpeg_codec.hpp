// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <tl/expected.hpp>

#include "common/image/rgbd_frame.hpp"

namespace rds::keyframe_codec {

struct FreeJpegHandle {
  void operator()(void* handle) const;
};
using JpegHandle = std::unique_ptr<void, FreeJpegHandle>;

/// Compresses colour pictures to baseline JPEG without subsampling of colour (4:4:4). Not thread-safe; keeps
/// its buffer, which is as large as the largest picture so far.
class JpegCompressor {
 public:
  /// @param quality  1 to 100, as libjpeg counts. @throws std::invalid_argument for others.
  explicit JpegCompressor(int quality);

  std::vector<std::uint8_t> compress(const image::ColorImage& picture);

 private:
  int quality_;
  JpegHandle handle_;
  std::vector<std::uint8_t> buffer_;
};

/// Decodes JPEG data of anyone: sequential, 8 bits, three components in one scan, and of this size.
///
/// @param size  of the picture, as whoever sent the bytes declares it.
/// @return rows without padding of three bytes a pixel, or a fixed sentence: another kind or size, or
/// libjpeg-turbo warns (torn, no such code). No picture is allocated before the header says the same size.
tl::expected<std::vector<std::uint8_t>, std::string> decompress_jpeg(std::span<const std::uint8_t> data,
                                                                     cv::Size size,
                                                                     image::ChannelOrder order);

}  // namespace rds::keyframe_codec
