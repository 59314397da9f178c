// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <string>

#include "services/viewer/core/board/board.hpp"
#include "services/viewer/core/frames/conversation.hpp"

namespace rds::viewer {

inline constexpr const char* kPageProtocol = "rds.view.v1";

/// What a page may ask of the services.
struct PageCommand {
  std::string verb;      // pause, resume, reset, save
  std::string argument;  // save: the name of the map
};

/// One page: gets the board; switches the picture on and off, and sends commands where they are allowed.
class PageClient final : public Conversation {
 public:
  using Send = std::function<void(const PageCommand&)>;

  /// @param board  outlives this.
  explicit PageClient(const Board& board) : board_(board) {}

  /// Commands are allowed, and sent so.
  void allow(Send send) { send_ = std::move(send); }

  bool receive(std::string_view message, bool binary) override;
  std::optional<Outgoing> next() override;

  [[nodiscard]] bool wants_picture() const { return cursor_.wants_picture; }
  /// An answer for this page; the oldest go where too many wait.
  void reply(Bytes frame);

 private:
  static constexpr std::size_t kMostReplies = 16;
  bool command(const std::string& verb, const std::string& argument);

  const Board& board_;
  Send send_;  // empty: commands are not allowed
  BoardCursor cursor_;
  std::deque<SharedBytes> replies_;
};

}  // namespace rds::viewer
