// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "services/viewer/core/frames/frame.hpp"

namespace rds::viewer {

/// A WebSocket message to a client.
struct Outgoing {
  SharedBytes bytes;
  bool binary = true;
};

/// What is said with one WebSocket client, whatever the socket is. The server asks for the next message when
/// the one before is out, so at most one is under way.
class Conversation {
 public:
  Conversation() = default;
  Conversation(const Conversation&) = delete;
  Conversation& operator=(const Conversation&) = delete;
  virtual ~Conversation() = default;

  /// A message of the client. @return false if no client of this protocol says such a thing: it is left.
  virtual bool receive(std::string_view message, bool binary) = 0;
  /// What to send next; nullopt while there is nothing.
  virtual std::optional<Outgoing> next() = 0;
};

}  // namespace rds::viewer
