// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "services/viewer/server/web_app.hpp"

namespace rds::viewer {

struct ServerLimits {
  std::size_t connections = 128;          // at once; one more is closed at once
  std::size_t clients = 32;               // of them by WebSocket
  std::size_t message_bytes = 64 * 1024;  // of a client's WebSocket message
  std::chrono::seconds request_time{15};  // until a request is there and its answer is out
  std::chrono::seconds silence{120};      // a WebSocket that answers no ping for so long is closed
};

struct ServerCounts {
  std::uint64_t connections = 0;  // so far
  std::uint64_t refused = 0;      // closed or answered with an error: too many, not allowed, not understood
  std::uint64_t malformed = 0;    // closed for what is no HTTP, or no WebSocket frame, or too long
  std::uint64_t refused_messages = 0;  // WebSocket messages that mean nothing
  std::size_t clients = 0;             // WebSockets now
};

/// HTTP and WebSocket on one port, all on the thread that calls serve_for(). At most one message a client is
/// under way, so what is kept for it does not depend on how slow it is.
class WebServer {
 public:
  /// Listens from now on. @param port  0: one that is free. @param app  outlives this.
  /// @throws std::runtime_error with one sentence where the address cannot be had.
  WebServer(const std::string& address, std::uint16_t port, const ServerLimits& limits, WebApp& app);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// Serves for so long.
  void serve_for(std::chrono::milliseconds duration);
  /// Does what can be done without waiting.
  void serve_what_is_due();
  /// Has serve_for() call this soon (any thread).
  void post(std::function<void()> task);
  /// There may be something new to send: asks each client that has nothing under way.
  void pump();

  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] const ServerCounts& counts() const;

 private:
  class Listener;
  std::unique_ptr<Listener> listener_;
};

}  // namespace rds::viewer
