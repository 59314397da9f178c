// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/bus/service_server.hpp"
#include "common/service/ros/lifecycle.hpp"

namespace rds::service {

/// What a lifecycle manager of ROS 2 asks of a node (lifecycle_msgs): `~/change_state`, `~/get_state`,
/// `~/get_available_states`, `~/get_available_transitions`, `~/get_transition_graph`; and what it is told:
/// `~/transition_event`. Transitions are commands of the worker: deactivate is `pause`, activate `resume`,
/// cleanup `reset`; shutdown ends the process as a signal does.
class LifecycleServices {
 public:
  /// Gives a command to the worker, which tells how it went, once, on any thread. @return false if nobody
  /// takes it.
  using Post = std::function<bool(const std::string& verb, std::function<void(bool succeeded)> respond)>;

  /// @param stop  ends the process. @param begin  the state at first. @throws bus::BusError
  LifecycleServices(bus::Participant& bus, Post post, std::function<void()> stop,
                    const LifecycleState& begin = kActive);

  [[nodiscard]] bool is_active() const { return lifecycle_->state() == kActive; }

  /// To be told when the worker has paused or resumed; may outlive this.
  [[nodiscard]] std::function<void(bool paused)> when_paused() const;

 private:
  bus::ServiceServer serve_changes(bus::Participant& bus);

  std::shared_ptr<Lifecycle> lifecycle_;  // also of answers that are still to come
  Post post_;
  std::function<void()> stop_;
  bus::ServiceServer change_, state_, states_, transitions_, graph_;
};

}  // namespace rds::service
