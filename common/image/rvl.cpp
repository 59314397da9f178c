// SPDX-License-Identifier: Apache-2.0
#include "common/image/rvl.hpp"

#include <algorithm>
#include <optional>

namespace rds::image {
namespace {

constexpr std::size_t kNibblesPerWord = 8;
constexpr unsigned kBitsPerNibble = 3;  // of a number; the fourth says whether more come
constexpr unsigned kMaxBits = 30;

/// The numbers of the stream, one after the other.
class Numbers {
 public:
  explicit Numbers(std::span<const std::uint8_t> bytes)
      : bytes_(bytes.first(bytes.size() / 4 * 4)), nibbles_(2 * bytes_.size()) {}

  /// @return nullopt where the stream ends, or the number is larger than any that means something.
  std::optional<std::uint32_t> next() {
    std::uint32_t number = 0;
    for (unsigned bits = 0; bits < kMaxBits && at_ < nibbles_; bits += kBitsPerNibble) {
      const std::uint32_t nibble = next_nibble();
      number |= (nibble & 7U) << bits;
      if ((nibble & 8U) == 0) return number;
    }
    return std::nullopt;
  }

 private:
  /// The first of a word is in its highest bits, which are in its last byte.
  std::uint32_t next_nibble() {
    const std::size_t in_word = at_ % kNibblesPerWord;
    const std::uint8_t byte = bytes_[at_ / kNibblesPerWord * 4 + 3 - in_word / 2];
    ++at_;
    return in_word % 2 == 0 ? byte >> 4U : byte & 15U;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t nibbles_;
  std::size_t at_ = 0;
};

/// Goes through the stream. @param take  is given the index and the value of each value that is not 0.
/// @return whether it holds `count` values, and each has 16 bits.
template <class Take>
bool walk(std::span<const std::uint8_t> bytes, std::size_t count, Take take) {
  Numbers numbers(bytes);
  std::int64_t value = 0;
  for (std::size_t i = 0; i < count;) {
    const auto zeros = numbers.next();
    const auto values = numbers.next();
    if (!zeros || !values || *zeros + *values == 0) return false;
    if (*zeros > count - i || *values > count - i - *zeros) return false;
    i += *zeros;
    for (const std::size_t end = i + *values; i < end; ++i) {
      const auto folded = numbers.next();
      if (!folded) return false;
      const auto half = static_cast<std::int64_t>(*folded >> 1U);
      value += (*folded & 1U) != 0 ? -half - 1 : half;
      if (value < 1 || value > 0xFFFF) return false;
      take(i, static_cast<std::uint16_t>(value));
    }
  }
  return true;
}

}  // namespace

cv::Mat decompress_rvl(std::span<const std::uint8_t> bytes, cv::Size size) {
  if (size.width <= 0 || size.height <= 0) return {};
  const auto count = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  if (!walk(bytes, count, [](std::size_t, std::uint16_t) {})) return {};
  cv::Mat1w depth(size, std::uint16_t{0});
  walk(bytes, count,
       [values = depth.ptr<std::uint16_t>()](std::size_t i, std::uint16_t v) { values[i] = v; });
  return depth;
}

}  // namespace rds::image
