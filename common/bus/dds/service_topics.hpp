// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/bus/qos.hpp"

/// How ROS 2 carries services over DDS.
namespace rds::bus::detail {

inline std::string request_topic(const std::string& service) {
  return "rq/" + service + "Request";
}
inline std::string reply_topic(const std::string& service) {
  return "rr/" + service + "Reply";
}

/// Of both topics (rmw_qos_profile_services_default).
inline constexpr Qos kServiceQos{.reliable = true, .depth = 10};

/// How long an answer waits for who asked to be discovered: his request may come before his reader is known
/// here, and a reply written then would be lost.
inline constexpr int kCallerDiscoveryMs = 100;

}  // namespace rds::bus::detail
