// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <tl/expected.hpp>

#include "common/mcap/compression.hpp"

namespace rds::record {

struct Recovered {
  std::uint64_t messages = 0;
  std::string fault = {};  // what was wrong with the file; empty: nothing, it was left as it is
};

/// Replaces an MCAP file that was torn or damaged by one with all of its messages that can be read; whatever
/// happens, the old file or the new one is there.
/// @return or one sentence.
tl::expected<Recovered, std::string> recover(const std::filesystem::path& file,
                                             mcap::Compression compression);

}  // namespace rds::record
