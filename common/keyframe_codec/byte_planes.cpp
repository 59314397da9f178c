// SPDX-License-Identifier: Apache-2.0
#include "common/keyframe_codec/byte_planes.hpp"

#include <limits>
#include <stdexcept>

namespace rds::keyframe_codec {
namespace {

template <class T>
constexpr int kBits = std::numeric_limits<T>::digits;

template <class T>
T zigzag(T difference) {
  const T sign = static_cast<T>(0 - (difference >> (kBits<T> - 1)));
  return static_cast<T>(static_cast<T>(difference << 1) ^ sign);
}

template <class T>
T from_zigzag(T code) {
  return static_cast<T>((code >> 1) ^ static_cast<T>(0 - (code & 1)));
}

template <class T>
T before_row(const cv::Mat& pixels, int y) {
  return y > 0 ? *pixels.ptr<T>(y - 1) : T{0};
}

template <class T>
void spread(const cv::Mat& pixels, std::span<std::uint8_t> planes) {
  const std::size_t count = pixels.total();
  std::uint8_t* out = planes.data();
  for (int y = 0; y < pixels.rows; ++y) {
    const T* row = pixels.ptr<T>(y);
    T last = before_row<T>(pixels, y);
    for (int x = 0; x < pixels.cols; ++x, ++out) {
      const T code = zigzag(static_cast<T>(row[x] - last));
      last = row[x];
      for (std::size_t byte = 0; byte < sizeof(T); ++byte)
        out[byte * count] = static_cast<std::uint8_t>(code >> (8 * byte));
    }
  }
}

template <class T>
void gather(std::span<const std::uint8_t> planes, cv::Mat& pixels) {
  const std::size_t count = pixels.total();
  const std::uint8_t* in = planes.data();
  for (int y = 0; y < pixels.rows; ++y) {
    T* row = pixels.ptr<T>(y);
    T last = before_row<T>(pixels, y);
    for (int x = 0; x < pixels.cols; ++x, ++in) {
      std::uint32_t code = 0;
      for (std::size_t byte = 0; byte < sizeof(T); ++byte)
        code |= std::uint32_t{in[byte * count]} << (8 * byte);
      last = static_cast<T>(last + from_zigzag(static_cast<T>(code)));
      row[x] = last;
    }
  }
}

/// Calls `use` with a zero of the unsigned type that is as wide as a pixel.
template <class Use>
void with_pixel_type(const cv::Mat& pixels, std::size_t planes_size, const Use& use) {
  if (pixels.channels() != 1 || pixels.total() * pixels.elemSize() != planes_size)
    throw std::invalid_argument("expected one channel, and planes of the picture's size");
  switch (pixels.elemSize()) {
    case 1:
      return use(std::uint8_t{});
    case 2:
      return use(std::uint16_t{});
    case 4:
      return use(std::uint32_t{});
    default:
      throw std::invalid_argument("expected pixels of 8, 16 or 32 bits");
  }
}

}  // namespace

void to_byte_planes(const cv::Mat& pixels, std::span<std::uint8_t> planes) {
  with_pixel_type(pixels, planes.size(), [&]<class T>(T) { spread<T>(pixels, planes); });
}

void from_byte_planes(std::span<const std::uint8_t> planes, cv::Mat& pixels) {
  with_pixel_type(pixels, planes.size(), [&]<class T>(T) { gather<T>(planes, pixels); });
}

}  // namespace rds::keyframe_codec
