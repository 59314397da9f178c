// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/command_line/description.hpp"

namespace rds::command_line {

/// A page for man, section 1: options, subcommands with theirs, environment.
std::string manual_page(const CommandDescription& program, const std::string& version);

}  // namespace rds::command_line
