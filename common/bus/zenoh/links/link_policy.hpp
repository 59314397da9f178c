// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace rds::bus {

/// What this process does about links of Zenoh that do not come about: all its participants alike, as Zenoh
/// has one log for a process.
struct LinkPolicy {
  /// Is told in one sentence each, by any thread, what keeps others away, as a peer that is not reached, and
  /// when he is. Where RUST_LOG is set Zenoh logs for itself in place of it.
  std::function<void(const std::string& sentence)> tell = {};
  /// How long a client of Zenoh tries to reach its router before it throws. 0: until it is reached.
  std::chrono::milliseconds reach_within{0};
};

/// Before the first participant. By default nobody is told, and clients try for ever.
void set_link_policy(LinkPolicy policy);

namespace detail {

const LinkPolicy& link_policy();

/// Nothing is said of an endpoint that nobody has asked for.
void ignore_endpoint(const std::string& endpoint);

/// What the library calls with each line of its log.
void take_log_line(const char* text, std::size_t size);

}  // namespace detail
}  // namespace rds::bus
