// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rds::bus {

/// As ROS 2's `-r from:=to`: a topic whose full name is that of `from` goes by the full name of `to`.
struct Remapping {
  std::string from;
  std::string to;
};

/// Whether ROS 2 takes this as the name of a node or as one part of a topic's: letters, digits and
/// underscores, none of the digits first.
bool is_ros_name(std::string_view name);

/// "/robot1" of "robot1", "/robot1/" or "/robot1"; "/" of "" or "/".
/// @throws std::invalid_argument naming a part that is no ROS name.
std::string normal_namespace(const std::string& name);

/// Makes names of topics on the bus of those that a node says, as ROS 2 does.
class TopicNames {
 public:
  /// @throws std::invalid_argument as normal_namespace()
  TopicNames(const std::string& node_namespace, std::string node_name, std::span<const Remapping> remappings);

  /// A topic's name on the bus, without "rt/" and without a leading slash, after remapping (the first rule
  /// that fits holds): "/tf" stays what it is, "rds/odometry" is below the namespace, "~/state" below the
  /// node.
  [[nodiscard]] std::string full_name(const std::string& topic) const;
  [[nodiscard]] const std::string& node_namespace() const { return namespace_; }

 private:
  [[nodiscard]] std::string expanded(const std::string& name) const;

  std::string namespace_;  // "/robot1"
  std::string node_;
  std::vector<std::pair<std::string, std::string>> remappings_;  // full names
};

}  // namespace rds::bus
