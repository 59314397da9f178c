// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "common/service/ros/rosout.hpp"

namespace rds::service {

/// Makes the log of the process, on standard error.
void set_up_log(const std::string& name);

/// Has what is logged said on /rosout, too, while it is there. After set_up_log().
class LogOnTheBus {
 public:
  /// @param node  full name: "/robot1/rds_tracker". @throws bus::BusError
  LogOnTheBus(bus::Participant& bus, const std::string& node);
  ~LogOnTheBus();
  LogOnTheBus(const LogOnTheBus&) = delete;
  LogOnTheBus& operator=(const LogOnTheBus&) = delete;

 private:
  std::shared_ptr<Rosout> rosout_;
};

}  // namespace rds::service
