// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <tl/expected.hpp>
#include <yaml-cpp/yaml.h>

namespace rds::service {

/// Sets a parameter of ROS 2 in a map of settings: "camera.color" is `color` in section `camera`. Parameters
/// that every node of ROS has (use_sim_time and the like) are left out: time is what messages say.
void set_parameter(const std::string& name, const YAML::Node& value, YAML::Node& settings);

/// Sets what a parameter file of ROS 2 says for a node.
/// @param node  full name, "/robot1/rds_tracker".
/// @return or one sentence that names the file and what was expected.
tl::expected<void, std::string> read_parameter_file(const std::string& file, const std::string& node,
                                                    YAML::Node& settings);

/// Whether a name of a parameter file means this node; `*` stands for one part, `**` for any number of them.
bool is_meant(const std::string& pattern, const std::string& node);

}  // namespace rds::service
