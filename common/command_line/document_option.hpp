// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/App.hpp>

namespace rds::command_line {

/// Adds the hidden option --document man|bash|zsh: the program then writes its manual page, or a shell's
/// completion of its options, to stdout and ends with 0. All other options are to be there when the command
/// line is parsed.
void add_document_option(CLI::App& program, const std::string& version);

}  // namespace rds::command_line
