// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/keyframe_codec/depth_alternatives.hpp"

#include <algorithm>
#include <cstring>

#include <opencv2/imgcodecs.hpp>
#include <zstd.h>

namespace rds::bench {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::uint32_t zigzag(int value) {
  return static_cast<std::uint32_t>(value) << 1 ^ static_cast<std::uint32_t>(value >> 31);
}

int from_zigzag(std::uint32_t code) {
  return static_cast<int>(code >> 1) ^ -static_cast<int>(code & 1);
}

/// Numbers as groups of three bits with a bit that says whether another follows, the higher half of a byte
/// first.
class NibbleWriter {
 public:
  void put(std::uint32_t value) {
    do {
      const std::uint32_t rest = value >> 3;
      put_nibble((value & 7) | (rest > 0 ? 8U : 0U));
      value = rest;
    } while (value > 0);
  }
  Bytes take() { return std::move(bytes_); }

 private:
  void put_nibble(std::uint32_t nibble) {
    if (high_)
      bytes_.push_back(static_cast<std::uint8_t>(nibble << 4));
    else
      bytes_.back() = static_cast<std::uint8_t>(bytes_.back() | nibble);
    high_ = !high_;
  }
  Bytes bytes_;
  bool high_ = true;
};

class NibbleReader {
 public:
  explicit NibbleReader(const Bytes& bytes) : bytes_(bytes) {}
  std::uint32_t take() {
    std::uint32_t value = 0;
    for (int shift = 0;; shift += 3, ++at_) {
      const std::uint32_t nibble = at_ % 2 == 0 ? bytes_[at_ / 2] >> 4 : bytes_[at_ / 2] & 15;
      value |= (nibble & 7) << shift;
      if ((nibble & 8) == 0) break;
    }
    ++at_;
    return value;
  }

 private:
  const Bytes& bytes_;
  std::size_t at_ = 0;
};

/// Alternately the length of a run without and of one with measurements, after the latter the differences.
Bytes rvl(const cv::Mat1w& depth) {
  NibbleWriter out;
  int last = 0;
  for (auto at = depth.begin(); at != depth.end();) {
    const auto valid = std::find_if(at, depth.end(), [](std::uint16_t d) { return d != 0; });
    const auto end = std::find(valid, depth.end(), 0);
    out.put(static_cast<std::uint32_t>(valid - at));
    out.put(static_cast<std::uint32_t>(end - valid));
    for (at = valid; at != end; last = *at, ++at) out.put(zigzag(*at - last));
  }
  return out.take();
}

cv::Mat1w from_rvl(const Bytes& bytes, cv::Size size) {
  cv::Mat1w depth(size);
  NibbleReader in(bytes);
  int last = 0;
  for (auto at = depth.begin(); at != depth.end();) {
    for (std::uint32_t zeros = in.take(); zeros > 0; --zeros, ++at) *at = 0;
    for (std::uint32_t values = in.take(); values > 0; --values, ++at)
      *at = static_cast<std::uint16_t>(last += from_zigzag(in.take()));
  }
  return depth;
}

int gradient(int left, int above, int corner) {
  const auto [low, high] = std::minmax(left, above);
  return corner >= high ? low : corner <= low ? high : left + above - corner;
}

int predicted(const cv::Mat1w& depth, int y, int x) {
  if (x == 0) return y == 0 ? 0 : depth(y - 1, 0);
  return y == 0 ? depth(0, x - 1) : gradient(depth(y, x - 1), depth(y - 1, x), depth(y - 1, x - 1));
}

Bytes gradient_planes(const cv::Mat1w& depth) {
  const std::size_t count = depth.total();
  Bytes planes(2 * count);
  std::size_t i = 0;
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x, ++i) {
      const auto difference = static_cast<std::int16_t>(depth(y, x) - predicted(depth, y, x));
      const std::uint32_t code = zigzag(difference);
      planes[i] = static_cast<std::uint8_t>(code);
      planes[count + i] = static_cast<std::uint8_t>(code >> 8);
    }
  }
  return planes;
}

cv::Mat1w from_gradient_planes(const Bytes& planes, cv::Size size) {
  cv::Mat1w depth(size);
  const std::size_t count = depth.total();
  std::size_t i = 0;
  for (int y = 0; y < depth.rows; ++y)
    for (int x = 0; x < depth.cols; ++x, ++i) {
      const std::uint32_t code = planes[i] | std::uint32_t{planes[count + i]} << 8;
      depth(y, x) = static_cast<std::uint16_t>(predicted(depth, y, x) + from_zigzag(code));
    }
  return depth;
}

Bytes zstd(const Bytes& content, int level) {
  Bytes frame(ZSTD_compressBound(content.size()));
  frame.resize(ZSTD_compress(frame.data(), frame.size(), content.data(), content.size(), level));
  return frame;
}

Bytes from_zstd(const Bytes& frame) {
  Bytes content(ZSTD_getFrameContentSize(frame.data(), frame.size()));
  ZSTD_decompress(content.data(), content.size(), frame.data(), frame.size());
  return content;
}

Bytes plain(const cv::Mat1w& depth) {
  Bytes bytes(2 * depth.total());
  std::memcpy(bytes.data(), depth.data, bytes.size());
  return bytes;
}

cv::Mat1w from_plain(const Bytes& bytes, cv::Size size) {
  cv::Mat1w depth(size);
  std::memcpy(depth.data, bytes.data(), bytes.size());
  return depth;
}

}  // namespace

std::vector<DepthAlternative> depth_alternatives() {
  const auto png = [](const cv::Mat1w& depth) {
    Bytes bytes;
    cv::imencode(".png", depth, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1});
    return bytes;
  };
  return {
      {"png_1", png,
       [](const Bytes& b, cv::Size) { return cv::Mat1w(cv::imdecode(b, cv::IMREAD_UNCHANGED)); }},
      {"rvl", rvl, from_rvl},
      {"rvl_zstd_1", [](const cv::Mat1w& d) { return zstd(rvl(d), 1); },
       [](const Bytes& b, cv::Size size) { return from_rvl(from_zstd(b), size); }},
      {"plain_zstd_1", [](const cv::Mat1w& d) { return zstd(plain(d), 1); },
       [](const Bytes& b, cv::Size size) { return from_plain(from_zstd(b), size); }},
      {"gradient_zstd_1", [](const cv::Mat1w& d) { return zstd(gradient_planes(d), 1); },
       [](const Bytes& b, cv::Size size) { return from_gradient_planes(from_zstd(b), size); }},
  };
}

}  // namespace rds::bench
