// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include <opencv2/core.hpp>
#include <tl/expected.hpp>

namespace rds::image {

/// True if a JPEG or PNG stream runs to its end marker (EOI, IEND); other formats count as whole.
///
/// Decoders fill the missing part of a torn JPEG with grey and say nothing, so completeness is checked on the
/// stream.
bool is_whole_picture(std::span<const std::uint8_t> bytes);

/// The size that a JPEG or PNG stream says it has, before anything is decoded; sides above 65535 px count as
/// that. Empty if it says none, or is of another format.
cv::Size declared_size(std::span<const std::uint8_t> bytes);

/// Decodes a picture to 8-bit BGR (CV_8UC3) of the given size.
///
/// @return or one sentence that names the file: missing, truncated, not a picture, of another size.
tl::expected<cv::Mat, std::string> read_color_picture(const std::filesystem::path& file,
                                                      cv::Size expected_size);

/// Decodes a depth picture (CV_16UC1) of the given size; another type is an error as well.
tl::expected<cv::Mat, std::string> read_depth_picture(const std::filesystem::path& file,
                                                      cv::Size expected_size);

}  // namespace rds::image
