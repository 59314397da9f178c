// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "services/viewer/core/frames/conversation.hpp"
#include "services/viewer/core/web/request.hpp"

namespace rds::viewer {

/// What an HTTP request is answered with.
struct HttpAnswer {
  unsigned status = 200;
  std::string_view content_type = "text/plain; charset=utf-8";
  std::string_view file = {};  // of the program's own, which last
  std::string text = {};       // where there is no file
};

/// Whether a client may speak by WebSocket.
struct Opening {
  std::unique_ptr<Conversation> conversation;  // nullptr: no, as `refusal` says
  std::string protocol;
  HttpAnswer refusal = {};
};

/// What the server serves. Called on its thread alone.
class WebApp {
 public:
  WebApp() = default;
  WebApp(const WebApp&) = delete;
  WebApp& operator=(const WebApp&) = delete;
  virtual ~WebApp() = default;

  virtual HttpAnswer get(const Request& request) = 0;
  virtual Opening open(const Request& request) = 0;
  /// A conversation that open() gave is over; it is destroyed after this.
  virtual void close(Conversation& conversation) = 0;
};

}  // namespace rds::viewer
