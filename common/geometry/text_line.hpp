// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rds::geometry {

/// The words of a line; spaces, tabs, commas and a carriage return separate.
std::vector<std::string_view> split_words(std::string_view line);

/// A whole word as a finite number; nullopt otherwise.
std::optional<double> parse_number(std::string_view word);

/// A line fit to be shown in a message: quoted, at most 60 characters, unprintable ones as '?'.
std::string shown(std::string_view line);

}  // namespace rds::geometry
