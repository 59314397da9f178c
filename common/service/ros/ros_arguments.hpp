// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>
#include <yaml-cpp/yaml.h>

#include "common/bus/names/topic_names.hpp"

namespace rds::service {

/// A command line as a launch file of ROS 2 writes it: what stands between `--ros-args` and `--`, or the end,
/// and the program's own.
struct CommandLine {
  std::vector<std::string> own;
  std::vector<std::string> ros;
};
CommandLine split_command_line(const std::vector<std::string>& arguments);

/// What a launch file asks of a node.
struct RosArguments {
  std::optional<std::string> node_name;
  std::optional<std::string> node_namespace;
  std::optional<std::string> log_level;  // debug, info, warning, error
  std::vector<bus::Remapping> remappings;
  YAML::Node parameters;  // of this node, a map; those of ROS itself, such as use_sim_time, are left out
};

/// Takes `-r from:=to`, `-r __node:=name`, `-r __ns:=/name`, `-p name:=value`, `--params-file FILE` and
/// `--log-level LEVEL`, each also for one node alone (`-r node:from:=to`); the switches of ROS's log mean
/// nothing.
///
/// @param arguments  CommandLine::ros. @param node_name, node_namespace  where they name no others; of
/// parameter files the sections for that node hold ("/robot1/rds_tracker", "/**", "rds_tracker"), the later
/// ones before the earlier ones.
/// @return or one sentence that says what is wrong with which argument or file.
tl::expected<RosArguments, std::string> read_ros_arguments(const std::vector<std::string>& arguments,
                                                           const std::string& node_name,
                                                           const std::string& node_namespace);

}  // namespace rds::service
