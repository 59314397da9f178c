// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace rds::service {

/// The last few hundred durations of one stage; safe to use from any thread.
class LatencyWindow {
 public:
  void add_ms(double duration_ms);
  /// @param share  0 … 1. @return the quantile [ms]; 0 without samples.
  [[nodiscard]] double quantile_ms(double share) const;

 private:
  static constexpr std::size_t kSize = 512;
  mutable std::mutex mutex_;
  std::vector<double> ring_;
  std::size_t next_ = 0;
};

/// What a process tells about itself once a second on `diagnostics`: counters, latencies, queue depths.
///
/// References returned stay valid for its life; they may be used from any thread.
class Diagnostics {
 public:
  using Counter = std::atomic<std::uint64_t>;

  Counter& counter(const std::string& name);
  LatencyWindow& latency(const std::string& name);
  /// A value read when the report is made, e.g. a queue's depth.
  void gauge(const std::string& name, std::function<std::uint64_t()> read);

  /// Counts a message that was not used and logs the reason: the first of its kind, then every hundredth.
  void reject(const std::string& topic, const std::string& reason);

  /// All figures by name, as text.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> figures() const;
  /// Messages rejected since the start.
  [[nodiscard]] std::uint64_t rejected() const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, Counter> counters_;
  std::map<std::string, LatencyWindow> latencies_;
  std::map<std::string, std::function<std::uint64_t()>> gauges_;
  std::map<std::string, std::uint64_t> rejections_;
};

}  // namespace rds::service
