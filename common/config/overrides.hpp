// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/config_reader.hpp"

namespace rds::config {

/// A reader of a file in which other values win, section by section.
/// @param file  empty: there are no others. @param values  a map. @param source  of the values, named in
/// messages.
/// @throws ConfigError as ConfigReader::from_file()
ConfigReader from_file_with(const std::string& file, const YAML::Node& values, const std::string& source);

/// The same as one map. @throws YAML::Exception if the file cannot be read.
YAML::Node merged(const std::string& file, const YAML::Node& values);

}  // namespace rds::config
