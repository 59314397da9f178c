// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <CLI/App.hpp>

namespace rds {

/// Adds the recording that a subcommand reads, in one way for all: RECORDING, or --dataset RECORDING.
CLI::Option* add_recording_option(CLI::App& command, std::filesystem::path& recording);

}  // namespace rds
