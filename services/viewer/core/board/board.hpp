// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "services/viewer/core/board/path_line.hpp"
#include "services/viewer/core/frames/frame.hpp"
#include "services/viewer/core/map/map_chunks.hpp"

namespace rds::viewer {

/// How far a client is.
struct BoardCursor {
  std::array<std::uint64_t, kKinds> seen{};  // of each kind, the number of the frame that it has
  MapCursor map;
  PathCursor path;
  std::size_t turn = 0;        // which kind is looked at first
  bool wants_picture = false;  // pictures are sent to those who look at them
};

/// What there is to see now: of each kind the newest frame, the map, the path. A client that is slow skips
/// frames and gets newer ones; nothing waits for it here.
class Board {
 public:
  /// In place of the frame of its kind that was there.
  void put(Kind kind, Bytes frame);
  /// Forgets a kind: nobody new gets it.
  void remove(Kind kind) { newest_.at(static_cast<std::size_t>(kind)) = {}; }

  /// The next frame that a client lacks, kinds taking turns; nullptr if it lacks none.
  [[nodiscard]] SharedBytes next(BoardCursor& cursor) const;

  MapChunks map;
  PathLine path;

 private:
  struct Newest {
    std::uint64_t number = 0;
    SharedBytes frame;
  };
  [[nodiscard]] SharedBytes next_of(std::size_t kind, BoardCursor& cursor) const;

  std::array<Newest, kKinds> newest_;
  std::uint64_t numbers_ = 0;
};

}  // namespace rds::viewer
