// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include <tl/expected.hpp>

#include "common/map_file/byte_writer.hpp"
#include "common/map_file/regular_file.hpp"

namespace rds::map_file {

/// The parts of a saved map, each read and written by its own service.
using Sections = std::map<std::string, Bytes>;

inline constexpr std::uint32_t kFormatVersion = 4;

/// The file as bytes: magic, version, table of sections (name, size, SHA-256 of
/// the payload), SHA-256 of all that, payloads in the order of the table. Numbers are little-endian.
Bytes to_bytes(const Sections& sections);

/// @return the sections, or what is wrong in words that can follow "the file ": "is torn: …", "is damaged:
/// …".
tl::expected<Sections, std::string> sections_from_bytes(std::span<const std::uint8_t> bytes);

/// Reads a regular file.
/// @return the sections; or one sentence naming the file and what was expected, for a file that cannot be
/// read, is too large, is not a saved map, was written by a newer version, is torn or was altered.
tl::expected<Sections, std::string> read_map_file(const std::filesystem::path& file,
                                                  const FileLimits& limits = {});

}  // namespace rds::map_file
