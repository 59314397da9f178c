// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "common/mcap/compression.hpp"

namespace rds {

/// Adds --compression: lz4, zstd or none, of the chunks of MCAP files that are written.
void add_compression_option(CLI::App& command, mcap::Compression& compression);

}  // namespace rds
