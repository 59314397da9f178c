// SPDX-License-Identifier: Apache-2.0
#include "common/keyframe_codec/jpeg_header.hpp"

#include <cstddef>

namespace rds::keyframe_codec {
namespace {

constexpr std::uint8_t kStartOfImage = 0xD8;
constexpr std::uint8_t kBaseline = 0xC0;            // SOF0
constexpr std::uint8_t kExtendedSequential = 0xC1;  // SOF1, Huffman coding
constexpr std::uint8_t kStartOfScan = 0xDA;
constexpr std::uint8_t kComponents = 3;

/// Tables, restart interval, application data, comment. Other frames (progressive, arithmetic) are not among
/// them, nor markers without a length, which a decoder would step over differently.
bool may_stand_before_scan(std::uint8_t marker) {
  const bool is_table = marker == 0xC4 || marker == 0xDB || marker == 0xDD;
  return is_table || (marker >= 0xE0 && marker <= 0xEF) || marker == 0xFE;
}

/// Sample precision, height, width, number of components.
bool is_frame_of_three(std::span<const std::uint8_t> segment) {
  return segment.size() >= 6 && segment[0] == 8 && segment[5] == kComponents;
}

}  // namespace

bool has_one_sequential_scan(std::span<const std::uint8_t> data) {
  if (data.size() < 2 || data[0] != 0xFF || data[1] != kStartOfImage) return false;
  bool has_frame = false;
  std::size_t at = 2;
  while (at + 4 <= data.size() && data[at] == 0xFF) {
    const std::uint8_t marker = data[at + 1];
    if (marker == 0xFF) {  // a fill byte
      ++at;
      continue;
    }
    const std::size_t length = std::size_t{data[at + 2]} << 8 | data[at + 3];
    if (length < 2 || length > data.size() - at - 2) return false;
    const auto segment = data.subspan(at + 4, length - 2);
    if (marker == kStartOfScan) return has_frame && !segment.empty() && segment[0] == kComponents;
    if (marker == kBaseline || marker == kExtendedSequential) {
      if (has_frame || !is_frame_of_three(segment)) return false;
      has_frame = true;
    } else if (!may_stand_before_scan(marker)) {
      return false;
    }
    at += 2 + length;
  }
  return false;
}

}  // namespace rds::keyframe_codec
