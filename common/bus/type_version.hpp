// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "common/bus/participant.hpp"

namespace rds::bus::detail {

/// "RIHS01_<64 hex>"
bool is_type_hash(std::string_view text);

/// True if both endpoints are on one topic, with types of one name and of different definition. Who announces
/// no type hash (plain DDS programs, ROS 2 Humble) is taken at his type's name.
bool is_another_version(const DiscoveredEndpoint& own, const DiscoveredEndpoint& other);

}  // namespace rds::bus::detail
