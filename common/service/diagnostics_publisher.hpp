// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <thread>

#include "common/service/service.hpp"
#include "diagnostic_msgs/msg/DiagnosticArray.h"

namespace rds::service {

/// Publishes a process's figures on `diagnostics` once a second, from a thread of its own.
class DiagnosticsPublisher {
 public:
  explicit DiagnosticsPublisher(ServiceContext& context);

 private:
  void publish();

  ServiceContext& context_;
  bus::Publisher<diagnostic_msgs::msg::DiagnosticArray> publisher_;
  std::uint64_t troubles_before_ = 0;
  std::jthread thread_;  // last: it uses the members above
};

}  // namespace rds::service
