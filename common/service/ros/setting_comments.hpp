// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

namespace rds::service {

/// What the comments behind the settings of a YAML text say, by the settings' names in full ("camera.color"):
/// block maps of one key a line, as the shipped settings are written.
std::map<std::string, std::string> setting_comments(const std::string& yaml);

}  // namespace rds::service
