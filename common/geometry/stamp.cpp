// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/stamp.hpp"

#include <charconv>

#include <fmt/format.h>

namespace rds::geometry {
namespace {
constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::int64_t kSecondsEnd = std::int64_t{1} << 31;
constexpr int kDecimals = 9;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Nanoseconds of the digits behind the point.
std::optional<std::int64_t> fraction_ns(std::string_view digits) {
  std::int64_t ns = 0;
  for (std::size_t i = 0; i < digits.size() || i < kDecimals; ++i) {
    const char c = i < digits.size() ? digits[i] : '0';
    if (!is_digit(c)) return std::nullopt;
    if (i < kDecimals)
      ns = ns * 10 + (c - '0');
    else if (i == kDecimals && c >= '5')
      ++ns;
  }
  return ns;
}
}  // namespace

std::optional<std::int64_t> parse_stamp_ns(std::string_view seconds) {
  const std::size_t point = seconds.find('.');
  const std::string_view whole = seconds.substr(0, point);
  const std::string_view decimals = point == std::string_view::npos ? "" : seconds.substr(point + 1);
  if (whole.empty()) return std::nullopt;
  std::int64_t value = 0;
  for (const char c : whole) {
    if (!is_digit(c)) return std::nullopt;
    value = value * 10 + (c - '0');
    if (value >= kSecondsEnd) return std::nullopt;
  }
  const auto fraction = fraction_ns(decimals);
  if (!fraction) return std::nullopt;
  return value * kNanosecondsPerSecond + *fraction;
}

std::string format_stamp(std::int64_t stamp_ns) {
  const std::int64_t seconds = stamp_ns / kNanosecondsPerSecond;
  const std::int64_t fraction = stamp_ns % kNanosecondsPerSecond;
  if (fraction % 1000 == 0) return fmt::format("{}.{:06}", seconds, fraction / 1000);
  return fmt::format("{}.{:09}", seconds, fraction);
}

double stamp_seconds(std::int64_t stamp_ns) {
  const std::string text = format_stamp(stamp_ns);
  double seconds = 0;
  std::from_chars(text.data(), text.data() + text.size(), seconds);
  return seconds;
}

}  // namespace rds::geometry
