// SPDX-License-Identifier: Apache-2.0
#include "common/bus/dds/user_data.hpp"

#include <algorithm>

#include "common/bus/type_version.hpp"

namespace rds::bus::detail {
namespace {

constexpr std::string_view kKey = "typehash=";

}  // namespace

std::string type_hash_in(std::string_view user_data) {
  while (!user_data.empty()) {
    const std::string_view entry = user_data.substr(0, user_data.find(';'));
    if (entry.starts_with(kKey) && is_type_hash(entry.substr(kKey.size()))) {
      return std::string(entry.substr(kKey.size()));
    }
    user_data.remove_prefix(std::min(entry.size() + 1, user_data.size()));
  }
  return {};
}

}  // namespace rds::bus::detail
