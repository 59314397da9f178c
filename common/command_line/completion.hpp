// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/command_line/description.hpp"

namespace rds::command_line {

/// A file for bash-completion's folder.
std::string bash_completion(const CommandDescription& program);

/// A file for zsh's folder of functions, there called `_` and the program's name.
std::string zsh_completion(const CommandDescription& program);

}  // namespace rds::command_line
