// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/bus/participant.hpp"
#include "tools/rds/topic/topic_reader.hpp"

namespace rds::tools {

/// A topic and how many endpoints it has.
struct TopicSummary {
  std::string topic;
  std::string type;  // as ROS 2 names it: "nav_msgs/msg/Odometry"; a type of another shape keeps its DDS name
  int publishers = 0;
  int subscribers = 0;
};

/// By topic, then type; two rows for a topic that is used with two types.
std::vector<TopicSummary> summarise(const std::vector<bus::DiscoveredEndpoint>& endpoints);

/// "nav_msgs::msg::dds_::Odometry_" as "nav_msgs/msg/Odometry".
std::string ros_type_name(const std::string& dds_name);

/// The message with lists of more than `longest` elements cut: the first ones, then a text that tells how
/// many.
nlohmann::ordered_json shortened(const nlohmann::ordered_json& value, std::size_t longest);

/// Rate and regularity of arrivals: one line.
std::string rate_report(std::span<const Arrival> arrivals);
/// Bytes per second over the time from the first to the last arrival, and message sizes: one line.
std::string bandwidth_report(std::span<const Arrival> arrivals);

}  // namespace rds::tools
