// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <mutex>
#include <string>

#include "common/bus/participant.hpp"
#include "diagnostic_msgs/msg/DiagnosticArray.h"

namespace rds::test {

/// What services tell of themselves, the newest value of each name.
class ToldDiagnostics {
 public:
  explicit ToldDiagnostics(bus::Participant& bus)
      : subscription_(bus.subscribe<diagnostic_msgs::msg::DiagnosticArray>(
            "/diagnostics", bus::kStream, [this](const auto& message) {
              const std::lock_guard lock(mutex_);
              for (const auto& status : message->status())
                for (const auto& value : status.values()) values_[value.key()] = value.value();
            })) {}

  /// Empty before it was told.
  std::string operator()(const std::string& name) {
    const std::lock_guard lock(mutex_);
    return values_[name];
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::string> values_;
  bus::Subscription subscription_;  // last: its callback uses the members above
};

}  // namespace rds::test
