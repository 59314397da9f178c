// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/board/board.hpp"

#include <set>

#include <gmock/gmock.h>

#include "tests/unit/services/viewer/frame_reader.hpp"

namespace rds::viewer {
namespace {

std::string next_text(const Board& board, BoardCursor& cursor) {
  const SharedBytes frame = board.next(cursor);
  if (!frame) return "";
  test::FrameReader in(*frame);
  in.kind();
  return in.rest();
}

TEST(Board, GivesEachFrameOnce) {
  Board board;
  board.put(Kind::kHello, text_frame(Kind::kHello, "hello"));
  board.put(Kind::kTracking, text_frame(Kind::kTracking, "frame 1"));
  BoardCursor cursor;
  std::set<std::string> told{next_text(board, cursor), next_text(board, cursor)};
  EXPECT_EQ(told, (std::set<std::string>{"hello", "frame 1"}));
  EXPECT_EQ(board.next(cursor), nullptr);
  board.put(Kind::kTracking, text_frame(Kind::kTracking, "frame 2"));
  EXPECT_EQ(next_text(board, cursor), "frame 2");
}

TEST(Board, ASlowClientSkipsToTheNewestFrame) {
  Board board;
  BoardCursor slow;
  for (int i = 0; i < 1000; ++i) board.put(Kind::kTracking, text_frame(Kind::kTracking, std::to_string(i)));
  EXPECT_EQ(next_text(board, slow), "999");
  EXPECT_EQ(board.next(slow), nullptr);
}

TEST(Board, AKindThatComesAllTheTimeDoesNotKeepOthersBack) {
  Board board;
  BoardCursor cursor;
  board.put(Kind::kServices, text_frame(Kind::kServices, "services"));
  bool came = false;
  for (int i = 0; i < 3 && !came; ++i) {
    board.put(Kind::kTracking, text_frame(Kind::kTracking, "frame"));
    came = next_text(board, cursor) == "services";
  }
  EXPECT_TRUE(came);
}

TEST(Board, PicturesGoToThoseWhoWantThem) {
  Board board;
  board.put(Kind::kPicture, text_frame(Kind::kPicture, "picture"));
  BoardCursor blind;
  EXPECT_EQ(board.next(blind), nullptr);
  BoardCursor curious;
  curious.wants_picture = true;
  EXPECT_EQ(next_text(board, curious), "picture");
  board.remove(Kind::kPicture);
  BoardCursor late;
  late.wants_picture = true;
  EXPECT_EQ(board.next(late), nullptr);
}

}  // namespace
}  // namespace rds::viewer
