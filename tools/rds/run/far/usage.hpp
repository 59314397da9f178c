// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "tools/rds/run/services/fleet.hpp"

namespace rds::run {

/// What services used, as one machine tells another.
std::string usage_to_json(const std::map<std::string, ServiceUsage>& usage);
/// @throws std::runtime_error if the text is not that.
std::map<std::string, ServiceUsage> usage_from_json(const std::string& text);

}  // namespace rds::run
