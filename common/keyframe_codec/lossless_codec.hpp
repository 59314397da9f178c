// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <tl/expected.hpp>

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace rds::keyframe_codec {

/// Packs pictures of one channel without loss, each as one zstd frame that says its size and has a checksum.
/// It holds byte planes (to_byte_planes()) of the pixels; those of 16 bits are ranks (rank_values()), and the
/// planes of the values, a picture of one row, follow. Not thread-safe; keeps its buffers, which are as large
/// as the largest picture so far.
class LosslessCompressor {
 public:
  LosslessCompressor();

  /// @param pixels  CV_8UC1, CV_16UC1 or CV_32FC1. @throws std::invalid_argument for others.
  std::vector<std::uint8_t> compress(const cv::Mat& pixels);

 private:
  struct Free {
    void operator()(ZSTD_CCtx_s* context) const;
  };
  void fill_planes(const cv::Mat& pixels);

  std::unique_ptr<ZSTD_CCtx_s, Free> context_;
  cv::Mat1w ranks_;
  std::vector<std::uint8_t> planes_;
  std::vector<std::uint8_t> frame_;
};

/// The reverse, for bytes of anyone. Not thread-safe; keeps its buffer.
class LosslessDecompressor {
 public:
  LosslessDecompressor();

  /// @param size  of the picture, as whoever sent the bytes declares it. @param type  CV_8UC1, CV_16UC1 or
  /// CV_32FC1.
  /// @return its rows without padding, or a fixed sentence. Nothing is allocated before the frame says the
  /// same size, and no picture before it is whole.
  tl::expected<std::vector<std::uint8_t>, std::string> decompress(std::span<const std::uint8_t> data,
                                                                  cv::Size size, int type);

 private:
  struct Free {
    void operator()(ZSTD_DCtx_s* context) const;
  };
  /// @return what is wrong; empty if the planes are there.
  std::string fill_planes(std::span<const std::uint8_t> data, std::size_t bytes, int type);

  std::unique_ptr<ZSTD_DCtx_s, Free> context_;
  std::vector<std::uint8_t> planes_;
};

}  // namespace rds::keyframe_codec
