// SPDX-License-Identifier: Apache-2.0
#include "tests/hosts/maps/revisions.hpp"

#include <algorithm>
#include <sstream>

#include "common/messages/conversions.hpp"
#include "common/topics/topics.hpp"
#include "tests/hosts/figures.hpp"

namespace rds::test {
namespace {

using Clock = std::chrono::steady_clock;

/// Of a follower's lines: when it had which revision.
std::vector<std::pair<double, std::uint64_t>> steps_in(const std::string& printed) {
  std::vector<std::pair<double, std::uint64_t>> steps;
  std::istringstream lines(printed);
  for (std::pair<double, std::uint64_t> step; lines >> step.first >> step.second;) steps.push_back(step);
  return steps;
}

}  // namespace

double steady_s() {
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

Revisions::Revisions(bus::Participant& bus)
    : subscription_(bus.subscribe<rds_msgs::msg::OctreeDelta>(
          topics::kMapDelta.name, bus::kDelta,
          [this](const std::shared_ptr<const rds_msgs::msg::OctreeDelta>& delta) { take(*delta); })) {}

void Revisions::take(const rds_msgs::msg::OctreeDelta& delta) {
  const std::lock_guard lock(mutex_);
  by_revision_.emplace(delta.revision(), steady_s());
  by_stamp_.emplace(messages::to_nanoseconds(delta.header().stamp()), Clock::now());
}

std::uint64_t Revisions::newest() const {
  const std::lock_guard lock(mutex_);
  return by_revision_.empty() ? 0 : by_revision_.rbegin()->first;
}

std::vector<double> Revisions::delays_ms(const std::map<std::int64_t, Clock::time_point>& keyframes) const {
  const std::lock_guard lock(mutex_);
  std::vector<double> delays;
  for (const auto& [stamp, published] : keyframes)
    if (const auto delta = by_stamp_.find(stamp); delta != by_stamp_.end())
      delays.push_back(std::chrono::duration<double, std::milli>(delta->second - published).count());
  std::ranges::sort(delays);
  return delays;
}

FollowerFigures Revisions::follower(const std::string& printed, double end_s) const {
  const auto steps = steps_in(printed);
  FollowerFigures figures{.first_s = kNever};
  if (steps.size() < 2) return figures;
  const double first_at_s = steps[1].first;
  figures.first_s = first_at_s - steps[0].first;
  figures.steps = steps.size() - 1;
  std::vector<double> behind_s;
  const std::lock_guard lock(mutex_);
  for (const auto& [revision, known_s] : by_revision_) {
    if (known_s < first_at_s) continue;
    const auto there =
        std::ranges::find_if(steps, [r = revision](const auto& step) { return step.second >= r; });
    behind_s.push_back(std::max(0.0, (there == steps.end() ? end_s : there->first) - known_s));
  }
  std::ranges::sort(behind_s);
  figures.behind_p95_s = quantile(behind_s, 0.95);
  figures.behind_max_s = quantile(behind_s, 1);
  return figures;
}

}  // namespace rds::test
