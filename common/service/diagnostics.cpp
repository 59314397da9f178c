// SPDX-License-Identifier: Apache-2.0
#include "common/service/diagnostics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace rds::service {
namespace {
constexpr std::uint64_t kLogEvery = 100;
}

void LatencyWindow::add_ms(double duration_ms) {
  const std::lock_guard lock(mutex_);
  if (ring_.size() < kSize)
    ring_.push_back(duration_ms);
  else
    ring_[next_] = duration_ms;
  next_ = (next_ + 1) % kSize;
}

double LatencyWindow::quantile_ms(double share) const {
  std::vector<double> sorted;
  {
    const std::lock_guard lock(mutex_);
    sorted = ring_;
  }
  if (sorted.empty()) return 0;
  const auto rank = static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(sorted.size() - 1)));
  std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
  return sorted[static_cast<std::size_t>(rank)];
}

Diagnostics::Counter& Diagnostics::counter(const std::string& name) {
  const std::lock_guard lock(mutex_);
  return counters_[name];
}

LatencyWindow& Diagnostics::latency(const std::string& name) {
  const std::lock_guard lock(mutex_);
  return latencies_[name];
}

void Diagnostics::gauge(const std::string& name, std::function<std::uint64_t()> read) {
  const std::lock_guard lock(mutex_);
  gauges_[name] = std::move(read);
}

void Diagnostics::reject(const std::string& topic, const std::string& reason) {
  std::uint64_t count = 0;
  {
    const std::lock_guard lock(mutex_);
    count = ++rejections_[fmt::format("{}: {}", topic, reason)];
  }
  if (count % kLogEvery == 1) spdlog::warn("{}: message dropped, {} ({} so far)", topic, reason, count);
}

std::vector<std::pair<std::string, std::string>> Diagnostics::figures() const {
  std::vector<std::pair<std::string, std::string>> all;
  const std::lock_guard lock(mutex_);
  for (const auto& [name, value] : counters_) all.emplace_back(name, fmt::format("{}", value.load()));
  for (const auto& [name, window] : latencies_) {
    all.emplace_back(name + " p50 [ms]", fmt::format("{:.3f}", window.quantile_ms(0.5)));
    all.emplace_back(name + " p99 [ms]", fmt::format("{:.3f}", window.quantile_ms(0.99)));
  }
  for (const auto& [name, read] : gauges_) all.emplace_back(name, fmt::format("{}", read()));
  for (const auto& [what, count] : rejections_)
    all.emplace_back("rejected " + what, fmt::format("{}", count));
  return all;
}

std::uint64_t Diagnostics::rejected() const {
  const std::lock_guard lock(mutex_);
  return std::accumulate(rejections_.begin(), rejections_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const auto& entry) { return sum + entry.second; });
}

}  // namespace rds::service
