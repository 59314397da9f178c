// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/bus/service_server.hpp"
#include "common/service/ros/parameter_table.hpp"

namespace rds::service {

/// The parameter services that every node of ROS 2 has: `~/list_parameters`, `~/get_parameters`,
/// `~/get_parameter_types`, `~/describe_parameters`, `~/set_parameters`, `~/set_parameters_atomically`.
class ParameterServices {
 public:
  /// @throws bus::BusError
  ParameterServices(bus::Participant& bus, ParameterTable table);
  ParameterServices(const ParameterServices&) = delete;
  ParameterServices& operator=(const ParameterServices&) = delete;

 private:
  ParameterTable table_;
  std::vector<bus::ServiceServer> services_;  // last: they ask the table
};

}  // namespace rds::service
