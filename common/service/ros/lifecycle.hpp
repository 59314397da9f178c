// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace rds::service {

/// lifecycle_msgs/msg/State. Of a transition that is on its way there is one of its own.
struct LifecycleState {
  std::uint8_t id;
  const char* label;
  bool operator==(const LifecycleState& other) const { return id == other.id; }
};
inline constexpr LifecycleState kUnconfigured{1, "unconfigured"};
inline constexpr LifecycleState kInactive{2, "inactive"};
inline constexpr LifecycleState kActive{3, "active"};
inline constexpr LifecycleState kFinalized{4, "finalized"};

/// A transition that a manager may ask for, and the command that carries it out.
struct LifecycleTransition {
  std::uint8_t id;
  const char* label;
  LifecycleState start;
  LifecycleState during;
  LifecycleState goal;
  const char* verb;             // of the worker; "": there is nothing to do
  std::uint8_t success_id = 0;  // of the event that ends it; one more where it has failed
};
inline constexpr const char* kStopVerb = "stop";  // not for the worker: the process ends

/// All states and transitions, as rclcpp_lifecycle has them.
std::span<const LifecycleState> lifecycle_states();
std::span<const LifecycleTransition> lifecycle_transitions();

/// lifecycle_msgs/msg/TransitionEvent without its time.
struct LifecycleEvent {
  std::uint8_t id;
  const char* label;
  LifecycleState start;
  LifecycleState goal;
};

/// In which state of its life a service is. It begins as active, as nobody has to configure it, or where a
/// manager is to bring it up as unconfigured. One transition at a time. Safe to use from any thread.
class Lifecycle {
 public:
  /// @param tell  what happens, in order; under a lock.
  explicit Lifecycle(std::function<void(const LifecycleEvent&)> tell, const LifecycleState& begin = kActive)
      : tell_(std::move(tell)), state_(begin) {}

  [[nodiscard]] LifecycleState state() const;
  [[nodiscard]] std::vector<LifecycleTransition> available() const;
  /// Begins the transition of this id; with id 0 the one of this label.
  /// @return nullopt if there is none from this state: nothing happens.
  std::optional<LifecycleTransition> begin(std::uint8_t id, const std::string& label);
  /// The transition has been carried out, or not: then the state is that of before.
  void end(bool succeeded);
  /// Somebody has paused or resumed the service otherwise.
  void set_paused(bool paused);

 private:
  mutable std::mutex mutex_;
  std::function<void(const LifecycleEvent&)> tell_;
  LifecycleState state_;
  std::optional<LifecycleTransition> current_;
};

}  // namespace rds::service
