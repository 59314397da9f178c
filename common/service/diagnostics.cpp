// SPDX-License-Identifier: Apache-2.0
#include "common/service/diagnostics.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "common/service/process/printable.hpp"

namespace rds::service {
namespace {

constexpr std::chrono::seconds kLogInterval{10};
constexpr std::array<std::string_view, kRejections> kNames{"invalid",  "foreign",    "forged",
                                                           "outdated", "unexpected", "failed"};

}  // namespace

std::string_view name_of(Rejection rejection) {
  return kNames.at(static_cast<std::size_t>(rejection));
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

void Diagnostics::warning(const std::string& name, std::function<std::optional<std::string>()> read) {
  const std::lock_guard lock(mutex_);
  warnings_[name] = std::move(read);
}

std::map<std::string, std::string> Diagnostics::warnings() const {
  const std::lock_guard lock(mutex_);
  std::map<std::string, std::string> said;
  for (const auto& [name, read] : warnings_)
    if (auto text = read()) said.emplace(name, std::move(*text));
  return said;
}

void Diagnostics::forget_gauges() {
  const std::lock_guard lock(mutex_);
  gauges_.clear();
  warnings_.clear();
}

void Diagnostics::reject(const std::string& topic, Rejection code, std::string_view detail) {
  const auto now = std::chrono::steady_clock::now();
  std::uint64_t count = 0;
  {
    const std::lock_guard lock(mutex_);
    Rejected& rejected = rejections_[topic].at(static_cast<std::size_t>(code));
    count = ++rejected.count;
    if (count > 1 && now - rejected.logged < kLogInterval) return;
    rejected.logged = now;
  }
  spdlog::warn("{}: message dropped, {}: {} ({} so far)", topic, name_of(code), printable(detail), count);
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
  for (const auto& [topic, codes] : rejections_)
    for (std::size_t code = 0; code < kRejections; ++code)
      if (codes[code].count > 0)
        all.emplace_back(fmt::format("rejected {}: {}", topic, kNames[code]),
                         fmt::format("{}", codes[code].count));
  return all;
}

std::uint64_t Diagnostics::rejected() const {
  const std::lock_guard lock(mutex_);
  std::uint64_t sum = 0;
  for (const auto& [topic, codes] : rejections_)
    for (const Rejected& rejected : codes) sum += rejected.count;
  return sum;
}

}  // namespace rds::service
