// SPDX-License-Identifier: Apache-2.0
#include "common/keyframe_codec/jpeg_codec.hpp"

#include <new>
#include <stdexcept>

#include <turbojpeg.h>

#include "common/keyframe_codec/jpeg_header.hpp"

namespace rds::keyframe_codec {
namespace {

constexpr const char* kOtherKind = "the data is not a sequential JPEG of three components";
constexpr int kSubsampling = TJSAMP_444;  // docs/decisions/keyframe-codec.md

int format_of(image::ChannelOrder order) {
  return order == image::ChannelOrder::kRgb ? TJPF_RGB : TJPF_BGR;
}

JpegHandle checked(tjhandle handle) {
  if (handle == nullptr) throw std::bad_alloc();
  return JpegHandle(handle);
}

/// What is wrong with the header, a fixed sentence, empty if nothing.
std::string fault_of_header(std::span<const std::uint8_t> data, cv::Size size) {
  if (!has_one_sequential_scan(data)) return kOtherKind;
  const JpegHandle handle = checked(tjInitDecompress());
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int colorspace = 0;
  if (tjDecompressHeader3(handle.get(), data.data(), data.size(), &width, &height, &subsampling,
                          &colorspace) != 0)
    return kOtherKind;
  if (cv::Size(width, height) != size) return "the JPEG is of another size than declared";
  return {};
}

}  // namespace

void FreeJpegHandle::operator()(void* handle) const {
  tjDestroy(handle);
}

JpegCompressor::JpegCompressor(int quality) : quality_(quality), handle_(checked(tjInitCompress())) {
  if (quality < 1 || quality > 100) throw std::invalid_argument("a JPEG's quality must be 1 to 100");
}

std::vector<std::uint8_t> JpegCompressor::compress(const image::ColorImage& picture) {
  const cv::Mat& pixels = picture.pixels;
  buffer_.resize(tjBufSize(pixels.cols, pixels.rows, kSubsampling));
  unsigned char* out = buffer_.data();
  unsigned long size = buffer_.size();
  if (tjCompress2(handle_.get(), pixels.data, pixels.cols, static_cast<int>(pixels.step), pixels.rows,
                  format_of(picture.order), &out, &size, kSubsampling, quality_,
                  TJFLAG_NOREALLOC | TJFLAG_ACCURATEDCT) != 0)
    throw std::runtime_error(tjGetErrorStr2(handle_.get()));
  return {out, out + size};
}

tl::expected<std::vector<std::uint8_t>, std::string> decompress_jpeg(std::span<const std::uint8_t> data,
                                                                     cv::Size size,
                                                                     image::ChannelOrder order) {
  if (std::string fault = fault_of_header(data, size); !fault.empty())
    return tl::unexpected(std::move(fault));
  // A handle keeps the tables of earlier pictures, and after an error more than that; a new one takes less
  // than 1 us.
  const JpegHandle handle = checked(tjInitDecompress());
  const int row_bytes = 3 * size.width;
  std::vector<std::uint8_t> rows(static_cast<std::size_t>(row_bytes) * static_cast<std::size_t>(size.height));
  if (tjDecompress2(handle.get(), data.data(), data.size(), rows.data(), size.width, row_bytes, size.height,
                    format_of(order), TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING) != 0)
    return tl::unexpected<std::string>("the JPEG is damaged");
  return rows;
}

}  // namespace rds::keyframe_codec
