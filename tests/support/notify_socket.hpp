// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace rds::test {

/// What a process tells its supervisor: the receiving end of sd_notify(3), as systemd has it.
class NotifySocket {
 public:
  NotifySocket();
  ~NotifySocket();
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// For the environment variable NOTIFY_SOCKET.
  [[nodiscard]] std::string path() const { return (folder_ / "notify").string(); }

  /// Reads until a message holds `text`. @return all that came, that message included; without it when the time is
  /// over.
  std::vector<std::string> read_until(const std::string& text, std::chrono::milliseconds limit);
  /// All that comes in this time.
  std::vector<std::string> read_for(std::chrono::milliseconds time);

 private:
  TemporaryFolder folder_;
  int socket_;
};

}  // namespace rds::test
