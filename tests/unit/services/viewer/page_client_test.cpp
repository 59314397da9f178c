// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/board/page_client.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/unit/services/viewer/frame_reader.hpp"

namespace rds::viewer {
namespace {

using ::testing::HasSubstr;

std::string next_reply(PageClient& client) {
  const auto next = client.next();
  if (!next) return "";
  test::FrameReader in(*next->bytes);
  EXPECT_EQ(in.kind(), Kind::kReply);
  return in.rest();
}

TEST(PageClient, RefusesWhatNoPageSays) {
  const Board board;
  PageClient client(board);
  for (const char* said : {"", "{", "[]", "1", "{}", R"({"picture": 1})", R"({"command": 5})",
                           R"({"command": "rm"})", R"({"command": "save", "argument": {}})", "\xff\xfe"})
    EXPECT_FALSE(client.receive(said, false)) << said;
  EXPECT_FALSE(client.receive(R"({"picture": true})", true)) << "binary";
  EXPECT_FALSE(client.wants_picture());
  EXPECT_TRUE(client.receive(R"({"picture": true})", false));
  EXPECT_TRUE(client.wants_picture());
}

TEST(PageClient, SendsNoCommandsUnlessTheyAreAllowed) {
  const Board board;
  PageClient client(board);
  EXPECT_TRUE(client.receive(R"({"command": "reset"})", false));
  EXPECT_THAT(next_reply(client), HasSubstr("not allowed"));
  std::vector<PageCommand> sent;
  client.allow([&](const PageCommand& command) { sent.push_back(command); });
  EXPECT_TRUE(client.receive(R"({"command": "save", "argument": "kitchen"})", false));
  EXPECT_TRUE(client.receive(R"({"command": "save", "argument": "../kitchen"})", false));
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].argument, "kitchen");
  EXPECT_THAT(next_reply(client), HasSubstr("\"success\":false"));
}

TEST(PageClient, KeepsFewReplies) {
  const Board board;
  PageClient client(board);
  for (int i = 0; i < 100; ++i) client.reply(text_frame(Kind::kReply, std::to_string(i)));
  EXPECT_EQ(next_reply(client), "84");
  int left = 0;
  while (client.next()) ++left;
  EXPECT_EQ(left, 15);
}

}  // namespace
}  // namespace rds::viewer
