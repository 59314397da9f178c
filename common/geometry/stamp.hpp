// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rds::geometry {

/// Decimal seconds ("1305031229.528748") to nanoseconds, digit by digit: no double in between, so no rounding
/// up to nine decimals; a tenth decimal rounds.
///
/// @return nullopt for anything but digits with at most one point, or from 2^31 s on (a ROS stamp ends
/// there).
std::optional<std::int64_t> parse_stamp_ns(std::string_view seconds);

/// Nanoseconds ≥ 0 to decimal seconds with six decimals, or nine where six do not hold the value.
std::string format_stamp(std::int64_t stamp_ns);

/// The double nearest to the stamp [s], as reading its decimal text gives it.
double stamp_seconds(std::int64_t stamp_ns);

}  // namespace rds::geometry
