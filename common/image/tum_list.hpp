// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace rds::image {

/// One line of rgb.txt or depth.txt.
struct TumListEntry {
  std::int64_t stamp_ns = 0;
  std::string stamp_text;         // the digits as they stand in the file
  std::filesystem::path picture;  // absolute or relative to the working directory, ready to open
  int line = 0;
};

struct TumList {
  std::vector<TumListEntry> entries;  // stamps increase
  std::size_t repeated = 0;           // lines left out because their stamp equals the one before
};

/// Reads a list of pictures, `timestamp filename` per line, `#` comments; file names are relative to the
/// list.
///
/// @return or one sentence that names file, line and expectation: unreadable or empty list, malformed line,
/// stamps that go backwards.
tl::expected<TumList, std::string> read_tum_list(const std::filesystem::path& file);

}  // namespace rds::image
