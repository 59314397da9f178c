// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/cli/compression_option.hpp"

#include <map>
#include <string>

#include <CLI/CLI.hpp>

namespace rds {

void add_compression_option(CLI::App& command, mcap::Compression& compression) {
  static const std::map<std::string, mcap::Compression> kNames{{"lz4", mcap::Compression::kLz4},
                                                               {"zstd", mcap::Compression::kZstd},
                                                               {"none", mcap::Compression::kNone}};
  command
      .add_option_function<std::string>(
          "--compression", [&compression](const std::string& name) { compression = kNames.at(name); },
          "of an MCAP file: lz4, zstd or none")
      ->check(CLI::IsMember({"lz4", "zstd", "none"}))
      ->default_str("lz4");
}

}  // namespace rds
