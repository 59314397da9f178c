// SPDX-License-Identifier: Apache-2.0
#include "common/keyframe_codec/lossless_codec.hpp"

#include <new>
#include <optional>
#include <utility>

#include <zstd.h>

#include "common/keyframe_codec/byte_planes.hpp"
#include "common/keyframe_codec/value_ranks.hpp"

namespace rds::keyframe_codec {
namespace {

constexpr int kLevel = 1;  // docs/decisions/keyframe-codec.md
constexpr std::uint32_t kMagic = ZSTD_MAGICNUMBER;

std::size_t bytes_of(cv::Size size, int type) {
  return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * CV_ELEM_SIZE(type);
}

/// How many values follow the planes of such a picture in a frame of this size; nullopt if it is none.
std::optional<std::size_t> values_in(std::uint64_t frame_content, std::size_t planes, int type) {
  if (frame_content < planes) return std::nullopt;
  const std::uint64_t rest = frame_content - planes;
  if (type != CV_16UC1) return rest == 0 ? std::optional<std::size_t>(0) : std::nullopt;
  if (rest == 0 || rest % 2 != 0 || rest / 2 > kMostValues) return std::nullopt;
  return rest / 2;
}

/// The values, a row, over their memory.
cv::Mat as_row(std::vector<std::uint16_t>& values) {
  return {1, static_cast<int>(values.size()), CV_16UC1, values.data()};
}

/// Values in place of their ranks. @return false if one is missing.
bool insert_values(std::span<const std::uint8_t> planes, cv::Mat1w pixels) {
  std::vector<std::uint16_t> values(planes.size() / 2);
  cv::Mat row = as_row(values);
  from_byte_planes(planes, row);
  return values_of_ranks(values, pixels);
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

void LosslessCompressor::fill_planes(const cv::Mat& pixels) {
  const std::size_t size = bytes_of(pixels.size(), pixels.type());
  planes_.resize(size);
  if (pixels.type() != CV_16UC1) return to_byte_planes(pixels, planes_);
  std::vector<std::uint16_t> values = rank_values(pixels, ranks_);
  planes_.resize(size + 2 * values.size());
  to_byte_planes(ranks_, std::span(planes_).first(size));
  to_byte_planes(as_row(values), std::span(planes_).subspan(size));
}

std::vector<std::uint8_t> LosslessCompressor::compress(const cv::Mat& pixels) {
  fill_planes(pixels);
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

std::string LosslessDecompressor::fill_planes(std::span<const std::uint8_t> data, std::size_t bytes,
                                              int type) {
  if (!is_frame(data) || ZSTD_findFrameCompressedSize(data.data(), data.size()) != data.size())
    return "the data is not one whole zstd frame";
  const auto values = values_in(ZSTD_getFrameContentSize(data.data(), data.size()), bytes, type);
  if (!values) return "the zstd frame is of another size than declared";
  planes_.resize(bytes + 2 * *values);
  const std::size_t size =
      ZSTD_decompressDCtx(context_.get(), planes_.data(), planes_.size(), data.data(), data.size());
  return size == planes_.size() ? "" : "the zstd frame is damaged";
}

tl::expected<std::vector<std::uint8_t>, std::string> LosslessDecompressor::decompress(
    std::span<const std::uint8_t> data, cv::Size size, int type) {
  const std::size_t bytes = bytes_of(size, type);
  if (std::string fault = fill_planes(data, bytes, type); !fault.empty())
    return tl::unexpected(std::move(fault));
  std::vector<std::uint8_t> rows(bytes);
  cv::Mat pixels(size, type, rows.data());
  from_byte_planes(std::span(planes_).first(bytes), pixels);
  if (type == CV_16UC1 && !insert_values(std::span(planes_).subspan(bytes), pixels))
    return tl::unexpected<std::string>("a pixel has no value");
  return rows;
}

void LosslessDecompressor::Free::operator()(ZSTD_DCtx_s* context) const {
  ZSTD_freeDCtx(context);
}

}  // namespace rds::keyframe_codec
