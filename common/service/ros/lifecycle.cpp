// SPDX-License-Identifier: Apache-2.0
#include "common/service/ros/lifecycle.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace rds::service {
namespace {

constexpr LifecycleState kConfiguring{10, "configuring"};
constexpr LifecycleState kCleaningUp{11, "cleaningup"};
constexpr LifecycleState kShuttingDown{12, "shuttingdown"};
constexpr LifecycleState kActivating{13, "activating"};
constexpr LifecycleState kDeactivating{14, "deactivating"};

constexpr std::array kStates{LifecycleState{0, "unknown"},
                             kUnconfigured,
                             kInactive,
                             kActive,
                             kFinalized,
                             kConfiguring,
                             kCleaningUp,
                             kShuttingDown,
                             kActivating,
                             kDeactivating,
                             LifecycleState{15, "errorprocessing"}};

constexpr std::array<LifecycleTransition, 7> kTransitions{
    {{1, "configure", kUnconfigured, kConfiguring, kInactive, "", 10},
     {2, "cleanup", kInactive, kCleaningUp, kUnconfigured, "reset", 20},
     {3, "activate", kInactive, kActivating, kActive, "resume", 30},
     {4, "deactivate", kActive, kDeactivating, kInactive, "pause", 40},
     {5, "shutdown", kUnconfigured, kShuttingDown, kFinalized, kStopVerb, 50},
     {6, "shutdown", kInactive, kShuttingDown, kFinalized, kStopVerb, 50},
     {7, "shutdown", kActive, kShuttingDown, kFinalized, kStopVerb, 50}}};

}  // namespace

std::span<const LifecycleState> lifecycle_states() {
  return kStates;
}

std::span<const LifecycleTransition> lifecycle_transitions() {
  return kTransitions;
}

LifecycleState Lifecycle::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

std::vector<LifecycleTransition> Lifecycle::available() const {
  const LifecycleState now = state();
  std::vector<LifecycleTransition> from_here;
  std::ranges::copy_if(kTransitions, std::back_inserter(from_here),
                       [&](const LifecycleTransition& t) { return t.start == now; });
  return from_here;
}

std::optional<LifecycleTransition> Lifecycle::begin(std::uint8_t id, const std::string& label) {
  const std::lock_guard lock(mutex_);
  const auto* found = std::ranges::find_if(kTransitions, [&](const LifecycleTransition& t) {
    return t.start == state_ && (id == 0 ? label == t.label : id == t.id);
  });
  if (found == kTransitions.end()) return std::nullopt;
  current_ = *found;
  state_ = found->during;
  tell_({found->id, found->label, found->start, found->during});
  return current_;
}

void Lifecycle::end(bool succeeded) {
  const std::lock_guard lock(mutex_);
  const auto ended = std::exchange(current_, std::nullopt);
  if (!ended) return;
  state_ = succeeded ? ended->goal : ended->start;
  const auto id = static_cast<std::uint8_t>(ended->success_id + (succeeded ? 0 : 1));
  tell_({id, succeeded ? "transition_success" : "transition_failure", ended->during, state_});
}

void Lifecycle::set_paused(bool paused) {
  const std::lock_guard lock(mutex_);
  if (current_ || state_ == kFinalized || paused == (state_ != kActive)) return;
  const LifecycleTransition& same = kTransitions[paused ? 3 : 2];  // deactivate, activate
  tell_({same.id, same.label, state_, same.goal});
  state_ = same.goal;
}

}  // namespace rds::service
