// SPDX-License-Identifier: Apache-2.0
#include "common/keyframe_codec/lossless_codec.hpp"

#include <new>

#include <zstd.h>

#include "common/keyframe_codec/byte_planes.hpp"

namespace rds::keyframe_codec {
namespace {

constexpr int kLevel = 1;  // docs/decisions/keyframe-codec.md
constexpr std::uint32_t kMagic = ZSTD_MAGICNUMBER;

std::size_t bytes_of(cv::Size size, int type) {
  return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * CV_ELEM_SIZE(type);
}

/// Whether the bytes begin as a frame of zstd's present format; libzstd would decode older ones and skip
/// others.
bool is_frame(std::span<const std::uint8_t> data) {
  if (data.size() < sizeof(kMagic)) return false;
  const std::uint32_t magic =
      data[0] | std::uint32_t{data[1]} << 8 | std::uint32_t{data[2]} << 16 | std::uint32_t{data[3]} << 24;
  return magic == kMagic;
}

}  // namespace

LosslessCompressor::LosslessCompressor() : context_(ZSTD_createCCtx()) {
  if (!context_) throw std::bad_alloc();
  ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, kLevel);
  ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_checksumFlag, 1);
}

std::vector<std::uint8_t> LosslessCompressor::compress(const cv::Mat& pixels) {
  planes_.resize(pixels.total() * pixels.elemSize());
  to_byte_planes(pixels, planes_);
  frame_.resize(ZSTD_compressBound(planes_.size()));
  const std::size_t size =
      ZSTD_compress2(context_.get(), frame_.data(), frame_.size(), planes_.data(), planes_.size());
  if (ZSTD_isError(size) != 0) throw std::bad_alloc();  // the bound leaves no other reason
  return {frame_.data(), frame_.data() + size};
}

void LosslessCompressor::Free::operator()(ZSTD_CCtx_s* context) const {
  ZSTD_freeCCtx(context);
}

LosslessDecompressor::LosslessDecompressor() : context_(ZSTD_createDCtx()) {
  if (!context_) throw std::bad_alloc();
}

tl::expected<std::vector<std::uint8_t>, std::string> LosslessDecompressor::decompress(
    std::span<const std::uint8_t> data, cv::Size size, int type) {
  const std::size_t bytes = bytes_of(size, type);
  if (!is_frame(data) || ZSTD_findFrameCompressedSize(data.data(), data.size()) != data.size())
    return tl::unexpected<std::string>("the data is not one whole zstd frame");
  if (ZSTD_getFrameContentSize(data.data(), data.size()) != bytes)
    return tl::unexpected<std::string>("the zstd frame is of another size than declared");
  planes_.resize(bytes);
  if (ZSTD_decompressDCtx(context_.get(), planes_.data(), bytes, data.data(), data.size()) != bytes)
    return tl::unexpected<std::string>("the zstd frame is damaged");
  std::vector<std::uint8_t> rows(bytes);
  cv::Mat pixels(size, type, rows.data());
  from_byte_planes(planes_, pixels);
  return rows;
}

void LosslessDecompressor::Free::operator()(ZSTD_DCtx_s* context) const {
  ZSTD_freeDCtx(context);
}

}  // namespace rds::keyframe_codec
