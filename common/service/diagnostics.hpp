// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
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

/// Why a message was not used. The codes are few and fixed, so that what a service keeps and publishes about
/// rejected messages never grows with what others send.
enum class Rejection : std::uint8_t {
  kInvalid,     // its contents are impossible: sizes, encodings, numbers that are not finite
  kForeign,     // of another tracker or loop closer than the one that is followed
  kForged,      // written in another one's name: an instance has one writer
  kOutdated,    // of a map epoch that is over, or older than what is known
  kUnexpected,  // nobody waits for it (any more)
  kFailed,      // processing it failed with an exception
};
inline constexpr std::size_t kRejections = 6;
std::string_view name_of(Rejection rejection);

/// What a process tells about itself once a second on `diagnostics`: counters, latencies, queue depths.
///
/// Names are the service's own, never text from outside: what is kept here is bounded. References returned stay
/// valid for its life; they may be used from any thread.
class Diagnostics {
 public:
  using Counter = std::atomic<std::uint64_t>;

  Counter& counter(const std::string& name);
  LatencyWindow& latency(const std::string& name);
  /// A value read when the report is made, e.g. a queue's depth.
  void gauge(const std::string& name, std::function<std::uint64_t()> read);
  /// What is wrong in a part of the service, read four times a second; nullopt while nothing is.
  void warning(const std::string& name, std::function<std::optional<std::string>()> read);
  /// Before what gauges and warnings read is destroyed.
  void forget_gauges();

  /// Counts a message that was not used, by topic and code, and logs it with the detail, made printable: the
  /// first of its kind, then at most one in ten seconds.
  void reject(const std::string& topic, Rejection code, std::string_view detail);

  /// All figures by name, as text.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> figures() const;
  /// What the warnings say, by their names.
  [[nodiscard]] std::map<std::string, std::string> warnings() const;
  /// Messages rejected since the start.
  [[nodiscard]] std::uint64_t rejected() const;

 private:
  struct Rejected {
    std::uint64_t count = 0;
    std::chrono::steady_clock::time_point logged;
  };
  mutable std::mutex mutex_;
  std::map<std::string, Counter> counters_;
  std::map<std::string, LatencyWindow> latencies_;
  std::map<std::string, std::function<std::uint64_t()>> gauges_;
  std::map<std::string, std::function<std::optional<std::string>()>> warnings_;
  std::map<std::string, std::array<Rejected, kRejections>> rejections_;  // by topic, as few as subscriptions
};

}  // namespace rds::service
