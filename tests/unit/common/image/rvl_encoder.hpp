// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace rds::image::test {

/// Depth in the form RVL, written from Wilson's paper: first all numbers, then all groups of bits, then the
/// words.
inline std::vector<std::uint8_t> rvl_of(const cv::Mat1w& depth) {
  std::vector<std::uint32_t> numbers;
  const std::vector<std::uint16_t> values(depth.begin(), depth.end());
  int before = 0;
  for (std::size_t i = 0; i < values.size();) {
    std::size_t begin = i;
    while (begin < values.size() && values[begin] == 0) ++begin;
    std::size_t end = begin;
    while (end < values.size() && values[end] != 0) ++end;
    numbers.push_back(static_cast<std::uint32_t>(begin - i));
    numbers.push_back(static_cast<std::uint32_t>(end - begin));
    for (i = begin; i < end; ++i) {
      const int difference = values[i] - before;
      before = values[i];
      numbers.push_back(static_cast<std::uint32_t>(difference < 0 ? -2 * difference - 1 : 2 * difference));
    }
  }
  std::vector<std::uint8_t> groups;
  for (std::uint32_t number : numbers) {
    for (; number > 7; number /= 8) groups.push_back(static_cast<std::uint8_t>(8 + number % 8));
    groups.push_back(static_cast<std::uint8_t>(number));
  }
  while (groups.size() % 8 != 0) groups.push_back(0);
  std::vector<std::uint8_t> bytes;
  for (std::size_t word = 0; word < groups.size(); word += 8)
    for (std::size_t byte = 4; byte-- > 0;)
      bytes.push_back(static_cast<std::uint8_t>(16 * groups[word + 2 * byte] + groups[word + 2 * byte + 1]));
  return bytes;
}

/// What compressed_depth_image_transport sends: its 12 bytes, columns, rows, then RVL.
inline std::vector<std::uint8_t> compressed_depth_of(
    const cv::Mat1w& depth, std::vector<std::uint8_t> head = std::vector<std::uint8_t>(12)) {
  for (const int side : {depth.cols, depth.rows})
    for (int shift = 0; shift < 32; shift += 8) head.push_back(static_cast<std::uint8_t>(side >> shift));
  const auto packed = rvl_of(depth);
  head.insert(head.end(), packed.begin(), packed.end());
  return head;
}

}  // namespace rds::image::test
