// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "services/mapper/reader/map_follower.hpp"
#include "services/viewer/core/board/board.hpp"

namespace rds::viewer {

/// Keeps the board's map as the mapper's is, wherever that runs.
class MapFeed {
 public:
  /// @param notify  called when the map has changed, on threads of the follower.
  MapFeed(service::ServiceContext& context, Board& board, std::function<void()> notify);

  /// Puts on the board what has changed.
  void take();

 private:
  Board& board_;
  std::function<void()> notify_;
  std::vector<std::string> labels_;
  std::mutex mutex_;  // of changed_
  ChangedChunks changed_;
  mapper::MapFollower map_;  // last: its threads call the listener
};

}  // namespace rds::viewer
