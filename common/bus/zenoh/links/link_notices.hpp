// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace rds::bus::detail {

/// Makes sentences for the user of what Zenoh logs of links that do not come about, each once: who is not
/// reached, and why, and when he is; whose certificate or version is refused. Thread-safe.
class LinkNotices {
 public:
  using Tell = std::function<void(const std::string& sentence)>;

  explicit LinkNotices(Tell tell) : tell_(std::move(tell)) {}

  /// Nothing is said of an endpoint that nobody has asked for.
  void ignore(const std::string& endpoint);
  /// One line of Zenoh's log.
  void take(std::string_view line);

 private:
  void take_not_reached(std::string_view line);
  void take_reached(std::string_view line);
  void say_once(const std::string& sentence);

  Tell tell_;
  std::mutex mutex_;  // of what follows
  std::set<std::string> ignored_;
  std::set<std::string> missing_;
  std::set<std::string> said_;
};

/// What is wrong, of an error of Zenoh: without what it was doing and the places in its source, and in plain
/// words where they are known.
std::string reason_of(std::string_view error);

}  // namespace rds::bus::detail
