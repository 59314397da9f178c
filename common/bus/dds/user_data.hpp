// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "common/bus/type_ops.hpp"

namespace rds::bus::detail {

/// Content of the USER_DATA policies, as ROS 2 writes them.
inline std::string endpoint_user_data(const TypeOps& type) {
  return type.type_hash.empty() ? "" : "typehash=" + type.type_hash + ";";
}
inline constexpr const char* kParticipantUserData = "enclave=/;";

/// The type hash in an endpoint's USER_DATA ("typehash=RIHS01_<64 hex>;", as ROS 2 writes it); "" if there is
/// none.
std::string type_hash_in(std::string_view user_data);

}  // namespace rds::bus::detail
