// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "common/bus/service_server.hpp"
#include "common/service/ros/parameter_table.hpp"
#include "rcl_interfaces/msg/Parameter.h"
#include "rcl_interfaces/msg/ParameterEvent.h"
#include "rcl_interfaces/msg/SetParametersResult.h"

namespace rds::service {

/// The parameter services that every node of ROS 2 has: `~/list_parameters`, `~/get_parameters`,
/// `~/get_parameter_types`, `~/describe_parameters`, `~/set_parameters`, `~/set_parameters_atomically`; and
/// what a node tells of changes: `/parameter_events`.
class ParameterServices {
 public:
  using Answered = std::function<void(bool success, const std::string& reason)>;
  /// Changes settings, all or none: a YAML map of names in full and values. Tells how it went, once, on any
  /// thread.
  using Set = std::function<void(const std::string& changes, Answered answered)>;

  /// @param node  its name in full. @throws bus::BusError
  ParameterServices(bus::Participant& bus, ParameterTable table, std::string node, Set set);
  ParameterServices(const ParameterServices&) = delete;
  ParameterServices& operator=(const ParameterServices&) = delete;

  /// Settings that have been changed, by names in full (any thread).
  void take(const std::map<std::string, YAML::Node>& changes);

 private:
  using Parameters = std::vector<rcl_interfaces::msg::Parameter>;

  /// @return what `read` makes of the table.
  template <class Read>
  auto locked(Read read) {
    const std::lock_guard lock(mutex_);
    return read(table_);
  }
  void serve_questions(bus::Participant& bus);
  void serve_changes(bus::Participant& bus);
  void set(const Parameters& parameters,
           const std::function<void(rcl_interfaces::msg::SetParametersResult)>& tell);

  std::mutex mutex_;
  ParameterTable table_;
  std::string node_;
  Set set_;
  bus::Publisher<rcl_interfaces::msg::ParameterEvent> events_;
  std::vector<bus::ServiceServer> services_;  // last: they ask the table
};

}  // namespace rds::service
