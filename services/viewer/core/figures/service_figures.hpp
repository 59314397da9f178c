// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rds::viewer {

/// Duration of a stage over its last few hundred times.
struct StageLatency {
  double p50_ms = 0;
  double p99_ms = 0;
};

/// What a service says of itself in diagnostics, sorted.
struct ServiceFigures {
  std::uint8_t level = 0;  // 0 ok, 1 warn, 2 error, 3 stale
  std::string message;
  double cpu_s = 0;
  double resident_mb = 0;
  double worker_silent_s = 0;
  std::map<std::string, StageLatency> latencies;                   // by stage
  std::map<std::string, double> dropped;                           // by topic
  std::map<std::pair<std::string, std::string>, double> rejected;  // by topic and reason
  std::map<std::string, double> counts;                            // counters and gauges, by name
  std::map<std::string, std::string> texts;                        // the rest
};

using KeyValues = std::vector<std::pair<std::string, std::string>>;

/// At most so many figures of a service are kept, each name and text cut to kMostTextBytes: what others
/// publish does not fill memory here.
inline constexpr std::size_t kMostFigures = 256;
inline constexpr std::size_t kMostTextBytes = 200;

/// Sorts the values of one status. Names as common/service writes them: "cpu [s]", "track p50 [ms]",
/// "dropped TOPIC", "rejected TOPIC: REASON".
ServiceFigures figures_of(std::uint8_t level, std::string_view message, const KeyValues& values);

/// All services that were heard of, by name; at most kMostServices.
class ServiceTable {
 public:
  static constexpr std::size_t kMostServices = 32;
  struct Entry {
    ServiceFigures figures;
    double heard_s = 0;  // when, by the caller's clock
  };

  /// @return false if there are too many services: this one is not taken.
  bool take(const std::string& name, ServiceFigures figures, double now_s);
  [[nodiscard]] const std::map<std::string, Entry>& entries() const { return entries_; }
  /// As the page gets it.
  [[nodiscard]] std::string to_json(double now_s) const;

 private:
  std::map<std::string, Entry> entries_;
};

}  // namespace rds::viewer
