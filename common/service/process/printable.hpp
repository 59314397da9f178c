// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace rds::service {

/// Text from outside in a form that harms no log, terminal or JSON: control characters, quotes' backslashes and
/// bytes that are not UTF-8 are written as \xNN; what is longer than `limit` bytes is cut, and says so.
std::string printable(std::string_view text, std::size_t limit = 200);

}  // namespace rds::service
