// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include <tl/expected.hpp>

namespace rds::map_file {

/// Writes beside the target, flushes to the disk and renames: whatever happens, the file is the old one or
/// the new.
/// @return or one sentence naming the file.
tl::expected<void, std::string> write_atomically(const std::filesystem::path& file,
                                                 std::span<const std::uint8_t> content);

inline tl::expected<void, std::string> write_atomically(const std::filesystem::path& file,
                                                        const std::string& content) {
  return write_atomically(file, {reinterpret_cast<const std::uint8_t*>(content.data()), content.size()});
}

}  // namespace rds::map_file
