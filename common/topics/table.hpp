// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "common/topics/topic.hpp"

namespace rds::topics {

/// A topic whose type is not known at compile time.
struct Row {
  std::string name;
  std::string type;  // "nav_msgs/msg/Odometry"
  std::initializer_list<Endpoint> writers;
  std::initializer_list<Endpoint> readers;
  bool is_global = false;

  /// As bus::Participant takes it.
  [[nodiscard]] std::string address() const { return is_global ? "/" + name : name; }

  [[nodiscard]] bool is_written_by(Process process) const;
  [[nodiscard]] bool is_read_by(Process process) const;
};

/// All topics, in the order of topics.hpp.
const std::vector<Row>& table();

/// Names of the topics that a process writes.
std::vector<std::string> written_by(Process process);

}  // namespace rds::topics
