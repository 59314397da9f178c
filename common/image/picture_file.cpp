// SPDX-License-Identifier: Apache-2.0
#include "common/image/picture_file.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace rds::image {
namespace {
using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', 0x0D, 0x0A, 0x1A, 0x0A};
constexpr std::array<std::uint8_t, 3> kJpegStart{0xFF, 0xD8, 0xFF};
constexpr std::array<std::uint8_t, 4> kPngEnd{'I', 'E', 'N', 'D'};

bool begins_with(Bytes bytes, Bytes prefix) {
  return bytes.size() >= prefix.size() && std::ranges::equal(bytes.first(prefix.size()), prefix);
}

/// Walks the chunks: length, type, data, CRC.
bool is_whole_png(Bytes bytes) {
  std::size_t at = kPngSignature.size();
  while (at + 12 <= bytes.size()) {
    const std::size_t length = static_cast<std::size_t>(bytes[at]) << 24 |
                               static_cast<std::size_t>(bytes[at + 1]) << 16 |
                               static_cast<std::size_t>(bytes[at + 2]) << 8 | bytes[at + 3];
    if (std::ranges::equal(bytes.subspan(at + 4, kPngEnd.size()), kPngEnd)) return true;
    at += 12 + length;
  }
  return false;
}

int big_endian_16(Bytes bytes, std::size_t at) {
  return bytes[at] << 8 | bytes[at + 1];
}

bool is_jpeg_standalone(std::uint8_t marker) {
  return marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8);
}

bool is_jpeg_frame(std::uint8_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

/// Walks the segments up to the end; inside entropy-coded data FF 00 is a byte and FF D0…D7 a restart.
/// @param look  at a segment's marker and where its length stands. @return whether there is an end.
template <class Look>
bool walk_jpeg(Bytes bytes, Look look) {
  constexpr std::uint8_t kEndOfImage = 0xD9;
  std::size_t at = 2;
  while (at + 1 < bytes.size()) {
    if (bytes[at] != 0xFF || bytes[at + 1] == 0x00 || bytes[at + 1] == 0xFF) {
      ++at;
      continue;
    }
    const std::uint8_t marker = bytes[at + 1];
    if (marker == kEndOfImage) return true;
    at += 2;
    if (is_jpeg_standalone(marker)) continue;
    if (at + 2 > bytes.size()) return false;
    look(marker, at);
    at += static_cast<std::size_t>(big_endian_16(bytes, at));
  }
  return false;
}

cv::Size png_size(Bytes bytes) {
  constexpr std::size_t kWidthAt = 16;
  constexpr int kMost = 0xFFFF;
  if (bytes.size() < kWidthAt + 8) return {};
  const auto side = [&](std::size_t at) {
    return big_endian_16(bytes, at) > 0 ? kMost : big_endian_16(bytes, at + 2);
  };
  return {side(kWidthAt), side(kWidthAt + 4)};
}

cv::Size jpeg_size(Bytes bytes) {
  cv::Size size;
  walk_jpeg(bytes, [&](std::uint8_t marker, std::size_t at) {
    if (is_jpeg_frame(marker) && at + 7 <= bytes.size())
      size = {big_endian_16(bytes, at + 5), big_endian_16(bytes, at + 3)};
  });
  return size;
}

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Decodes with OpenCV; its exceptions (impossible sizes in a header) become the same sentence as an empty
/// result.
tl::expected<cv::Mat, std::string> read_picture(const std::filesystem::path& file, int flags,
                                                cv::Size expected_size) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    return tl::unexpected(fmt::format("{}: no such file, expected a picture", file.string()));
  const auto bytes = read_bytes(file);
  if (bytes.empty())
    return tl::unexpected(fmt::format("{}: empty or unreadable, expected a picture", file.string()));
  if (!is_whole_picture(bytes))
    return tl::unexpected(
        fmt::format("{}: truncated after {} bytes, expected a whole picture", file.string(), bytes.size()));
  cv::Mat picture;
  try {
    picture = cv::imdecode(bytes, flags | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    picture.release();
  }
  if (picture.empty())
    return tl::unexpected(
        fmt::format("{}: cannot be decoded, expected a PNG or JPEG picture", file.string()));
  if (picture.size() != expected_size)
    return tl::unexpected(fmt::format("{}: {}×{} px, expected {}×{} as the camera's description says",
                                      file.string(), picture.cols, picture.rows, expected_size.width,
                                      expected_size.height));
  return picture;
}

}  // namespace

bool is_whole_picture(Bytes bytes) {
  if (begins_with(bytes, kPngSignature)) return is_whole_png(bytes);
  if (begins_with(bytes, kJpegStart)) return walk_jpeg(bytes, [](std::uint8_t, std::size_t) {});
  return true;
}

cv::Size declared_size(Bytes bytes) {
  if (begins_with(bytes, kPngSignature)) return png_size(bytes);
  if (begins_with(bytes, kJpegStart)) return jpeg_size(bytes);
  return {};
}

tl::expected<cv::Mat, std::string> read_color_picture(const std::filesystem::path& file,
                                                      cv::Size expected_size) {
  return read_picture(file, cv::IMREAD_COLOR, expected_size);
}

tl::expected<cv::Mat, std::string> read_depth_picture(const std::filesystem::path& file,
                                                      cv::Size expected_size) {
  auto picture = read_picture(file, cv::IMREAD_UNCHANGED, expected_size);
  if (picture && picture->type() != CV_16UC1)
    return tl::unexpected(
        fmt::format("{}: {} channel(s) of {} bits, expected depth as one channel of 16 bits", file.string(),
                    picture->channels(), 8 * picture->elemSize1()));
  return picture;
}

}  // namespace rds::image
