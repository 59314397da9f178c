// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <type_traits>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <tl/expected.hpp>

namespace rds::tools {

inline constexpr int kExitFault = 1;     // something is not as it should be
inline constexpr int kExitBadInput = 2;  // bad usage or unreadable input

/// Ends a subcommand: one sentence to stderr, and the process's exit status.
[[noreturn]] inline void exit_with(int status, const std::string& sentence) {
  fmt::print(stderr, "rds: {}\n", sentence);
  throw CLI::RuntimeError(status);
}

/// The value, or the end of the subcommand with the error's sentence as bad input.
template <class T>
T value_or_exit(tl::expected<T, std::string> result) {
  if (!result) exit_with(kExitBadInput, result.error());
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

}  // namespace rds::tools
