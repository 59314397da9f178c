// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/board/board.hpp"

#include <utility>

namespace rds::viewer {
namespace {

SharedBytes shared(std::optional<Bytes> frame) {
  return frame ? std::make_shared<const Bytes>(std::move(*frame)) : nullptr;
}

}  // namespace

void Board::put(Kind kind, Bytes frame) {
  newest_.at(static_cast<std::size_t>(kind)) = {++numbers_, std::make_shared<const Bytes>(std::move(frame))};
}

SharedBytes Board::next(BoardCursor& cursor) const {
  for (std::size_t looked = 0; looked < kKinds; ++looked) {
    const std::size_t kind = cursor.turn;
    cursor.turn = (cursor.turn + 1) % kKinds;
    if (SharedBytes frame = next_of(kind, cursor)) return frame;
  }
  return nullptr;
}

SharedBytes Board::next_of(std::size_t kind, BoardCursor& cursor) const {
  if (kind == static_cast<std::size_t>(Kind::kMap)) return shared(map.next(cursor.map));
  if (kind == static_cast<std::size_t>(Kind::kPath)) return shared(path.next(cursor.path));
  if (kind == static_cast<std::size_t>(Kind::kPicture) && !cursor.wants_picture) return nullptr;
  const Newest& newest = newest_.at(kind);
  if (!newest.frame || cursor.seen.at(kind) == newest.number) return nullptr;
  cursor.seen.at(kind) = newest.number;
  return newest.frame;
}

}  // namespace rds::viewer
