// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>

#include "diagnostic_msgs/msg/DiagnosticArray.h"

namespace rds::tools {

/// How a service is supplied that takes its input from another machine (common/transfer).
struct TransferFigures {
  std::uint64_t lacking = 0;  // items that should have come
  double round_trip_ms = 0;   // 0: nothing was measured
  double link_mbit_s = 0;     // what its link is taken to carry; 0: nothing was measured
};

/// What diagnostics say of services' transfers, by instance: nullopt for one that takes nothing in this way.
/// Safe to use from any thread.
class TransfersHeard {
 public:
  using Figures = std::map<std::uint64_t, std::optional<TransferFigures>>;

  void take(const diagnostic_msgs::msg::DiagnosticArray& report);
  [[nodiscard]] Figures figures() const;

 private:
  static constexpr std::size_t kMost = 256;  // instances, as Peers

  mutable std::mutex mutex_;
  Figures figures_;
};

}  // namespace rds::tools
