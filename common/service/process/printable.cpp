// SPDX-License-Identifier: Apache-2.0
#include "common/service/process/printable.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace rds::service {
namespace {

constexpr unsigned char kFirstPrintable = 0x20;
constexpr unsigned char kDelete = 0x7F;

bool is_continuation(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80;
}

/// Bytes of the UTF-8 sequence that the text begins with; 0 if it is none (overlong and surrogates included).
std::size_t sequence_length(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  if (!std::ranges::all_of(text.substr(1, length - 1), is_continuation)) return 0;
  const auto second = static_cast<unsigned char>(text[1]);
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool outside = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
  return overlong || outside ? 0 : length;
}

bool is_plain(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= kFirstPrintable && byte != kDelete && c != '\\';
}

}  // namespace

std::string printable(std::string_view text, std::size_t limit) {
  std::string shown;
  std::string_view rest = text;
  while (!rest.empty() && shown.size() < limit) {
    const std::size_t length = sequence_length(rest);
    if (length > 1 || (length == 1 && is_plain(rest[0]))) {
      shown += rest.substr(0, length);
      rest.remove_prefix(length);
    } else {
      shown += fmt::format("\\x{:02X}", static_cast<unsigned char>(rest[0]));
      rest.remove_prefix(1);
    }
  }
  if (!rest.empty()) shown += fmt::format("... ({} bytes)", text.size());
  return shown;
}

}  // namespace rds::service
