// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/text_line.hpp"

#include <charconv>
#include <cmath>

namespace rds::geometry {
namespace {
constexpr std::string_view kSeparators = " \t,\r";
constexpr std::size_t kLongestQuote = 60;
}  // namespace

std::vector<std::string_view> split_words(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t at = line.find_first_not_of(kSeparators);
  while (at != std::string_view::npos) {
    const std::size_t end = line.find_first_of(kSeparators, at);
    words.push_back(line.substr(at, end == std::string_view::npos ? end : end - at));
    at = end == std::string_view::npos ? end : line.find_first_not_of(kSeparators, end);
  }
  return words;
}

std::optional<double> parse_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string shown(std::string_view line) {
  std::string text = "\"";
  for (const char c : line.substr(0, kLongestQuote)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (line.size() > kLongestQuote ? "…\"" : "\"");
}

}  // namespace rds::geometry
