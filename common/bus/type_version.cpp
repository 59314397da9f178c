// SPDX-License-Identifier: Apache-2.0
#include "common/bus/type_version.hpp"

#include <algorithm>

namespace rds::bus::detail {
namespace {

constexpr std::string_view kKind = "RIHS01_";
constexpr std::size_t kDigits = 64;

}  // namespace

bool is_type_hash(std::string_view text) {
  if (!text.starts_with(kKind)) return false;
  text.remove_prefix(kKind.size());
  const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  return text.size() == kDigits && std::ranges::all_of(text, is_digit);
}

bool is_another_version(const DiscoveredEndpoint& own, const DiscoveredEndpoint& other) {
  return own.topic == other.topic && own.type == other.type && !own.type_hash.empty() &&
         !other.type_hash.empty() && own.type_hash != other.type_hash;
}

}  // namespace rds::bus::detail
