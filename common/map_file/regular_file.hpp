// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "common/map_file/descriptor.hpp"

namespace rds::map_file {

/// What ends the reading or writing of a file before its end.
struct FileLimits {
  std::uint64_t max_bytes = std::uint64_t{4} << 30;  // of one file
  std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();
  std::stop_token stop = {};
};

/// What is wrong with a file, in words that can follow "FILE: ".
using FileFault = std::string;

/// Reads an open file to its end. Open it with O_NONBLOCK: what is no regular file is refused before anything
/// is read from it.
/// @return or a fault: a device or pipe, too large, over the deadline, or an error of the disk.
tl::expected<std::vector<std::uint8_t>, FileFault> read_all(const Descriptor& file, const FileLimits& limits);

/// Writes all bytes and waits until the disk has them.
tl::expected<void, FileFault> write_durably(const Descriptor& file, std::span<const std::uint8_t> bytes,
                                            const FileLimits& limits);

/// The first bytes of a regular file, at most so many; none where there is no such file.
std::string start_of_file(const std::filesystem::path& file, std::size_t bytes);

/// A regular file that the user named; links are followed. @return or a fault.
tl::expected<std::vector<std::uint8_t>, FileFault> read_regular_file(const std::filesystem::path& file,
                                                                     const FileLimits& limits = {});

}  // namespace rds::map_file
