// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <stdexcept>
#include <string>

#include "common/bus/qos.hpp"

namespace rds::topics {

/// A process of this project, or a set of them.
enum class Process : std::uint8_t {
  kNone = 0,
  kTracker = 1,
  kDetector = 2,
  kTransformer = 4,
  kMapper = 8,
  kLoopCloser = 16,
  kServices = 31,
  kPlayer = 32,   // rds run, rds play
  kTool = 64,     // the other subcommands of rds
  kFarRun = 128,  // rds run on a machine without the camera
};
using enum Process;

constexpr Process operator|(Process a, Process b) {
  return static_cast<Process>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
constexpr bool contains(Process set, Process part) {
  return (static_cast<unsigned>(set) & static_cast<unsigned>(part)) == static_cast<unsigned>(part);
}

/// Who writes or reads a topic, and with which QoS.
struct Endpoint {
  Process processes;
  bus::Qos qos;
};

/// A topic's name, type, QoS, writers and readers.
template <class Message>
struct Topic {
  const char* name;  // without a leading slash
  std::initializer_list<Endpoint> writers;
  std::initializer_list<Endpoint> readers;
  /// Whether all robots share it, as everybody else in ROS 2 has it: not below a namespace, unless remapped.
  bool is_global = false;

  /// As bus::Participant takes it.
  [[nodiscard]] std::string address() const { return is_global ? std::string("/") + name : name; }

  /// The same under another name, which the caller keeps alive.
  [[nodiscard]] Topic named(const std::string& other) const {
    return {other.c_str(), writers, readers, is_global};
  }
};

/// @throws std::logic_error if the table does not name the process.
inline const bus::Qos& qos_of(Process process, std::initializer_list<Endpoint> endpoints, const char* topic) {
  for (const Endpoint& endpoint : endpoints)
    if (contains(endpoint.processes, process)) return endpoint.qos;
  throw std::logic_error(std::string(topic) + ": the table of topics does not name this process");
}

}  // namespace rds::topics
