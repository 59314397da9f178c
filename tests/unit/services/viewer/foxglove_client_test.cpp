// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/foxglove/foxglove_client.hpp"

#include <cstring>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace rds::viewer::foxglove {
namespace {

using nlohmann::json;

class FoxgloveClientTest : public ::testing::Test {
 protected:
  FoxgloveClientTest() {
    hello_ = json::parse(text());
    channels_told_ = json::parse(text());
  }
  std::string text() {
    const auto next = client_.next();
    EXPECT_TRUE(next && !next->binary);
    return next ? std::string(next->bytes->begin(), next->bytes->end()) : "{}";
  }
  void push(std::uint32_t channel, std::size_t bytes, std::uint8_t fill = 0) {
    client_.push({channel, 123, std::make_shared<const std::vector<std::uint8_t>>(bytes, fill)});
  }
  bool subscribe(std::uint32_t id, std::uint32_t channel) {
    return client_.receive(
        json{{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", channel}}}}}.dump(), false);
  }

  std::vector<Channel> channels_{
      {1, "/tf", "tf2_msgs/msg/TFMessage", "geometry_msgs/TransformStamped[] transforms"},
      {2, "/rds/odometry", "nav_msgs/msg/Odometry", "…"}};
  std::vector<std::uint32_t> begun_;
  FoxgloveClient client_{channels_, "abc",
                         [this](FoxgloveClient&, std::uint32_t channel) { begun_.push_back(channel); }};
  json hello_;
  json channels_told_;
};

TEST_F(FoxgloveClientTest, TellsWhatThereIsAndThatNothingCanBeChanged) {
  EXPECT_EQ(hello_["op"], "serverInfo");
  EXPECT_TRUE(hello_["capabilities"].empty());
  EXPECT_EQ(channels_told_["op"], "advertise");
  EXPECT_EQ(channels_told_["channels"].size(), 2U);
  const auto& first = channels_told_["channels"][0];
  EXPECT_EQ(first["encoding"], "cdr");
  EXPECT_EQ(first["schemaEncoding"], "ros2msg");
  EXPECT_EQ(first["schemaName"], "tf2_msgs/msg/TFMessage");
}

TEST_F(FoxgloveClientTest, SendsTheMessagesOfItsSubscriptionsAsTheyAre) {
  push(1, 3);
  EXPECT_FALSE(client_.next()) << "not subscribed";
  EXPECT_TRUE(subscribe(77, 1));
  EXPECT_THAT(begun_, ::testing::ElementsAre(1U));
  push(1, 3, 9);
  push(2, 3, 9);
  const auto message = client_.next();
  ASSERT_TRUE(message && message->binary);
  ASSERT_EQ(message->bytes->size(), 1U + 4 + 8 + 3);
  EXPECT_EQ((*message->bytes)[0], 1);
  std::uint32_t id = 0;
  std::uint64_t time = 0;
  std::memcpy(&id, message->bytes->data() + 1, 4);
  std::memcpy(&time, message->bytes->data() + 5, 8);
  EXPECT_EQ(id, 77U);
  EXPECT_EQ(time, 123U);
  EXPECT_EQ(message->bytes->back(), 9);
  EXPECT_FALSE(client_.next());
}

TEST_F(FoxgloveClientTest, UnsubscribingForgetsWhatWaits) {
  subscribe(77, 1);
  push(1, 3);
  EXPECT_TRUE(client_.receive(R"({"op": "unsubscribe", "subscriptionIds": [77]})", false));
  EXPECT_FALSE(client_.next());
  EXPECT_FALSE(client_.hears(1));
  EXPECT_TRUE(subscribe(77, 2)) << "the id is free again";
}

TEST_F(FoxgloveClientTest, RefusesWhatIsNotOffered) {
  subscribe(77, 1);
  for (const char* said : {"", "[]", "{", R"({"op": 1})", R"({"op": "advertise", "channels": []})",
                           R"({"op": "setParameters", "parameters": []})",
                           R"({"op": "fetchAsset", "uri": "package://x", "requestId": 1})",
                           R"({"op": "subscribe"})", R"({"op": "subscribe", "subscriptions": [5]})",
                           R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 99}]})",
                           R"({"op": "subscribe", "subscriptions": [{"id": 77, "channelId": 2}]})",
                           R"({"op": "subscribe", "subscriptions": [{"id": 5, "channelId": 1}]})",
                           R"({"op": "subscribe", "subscriptions": [{"id": -5, "channelId": 2}]})",
                           R"({"op": "subscribe", "subscriptions": [{"id": 99999999999, "channelId": 2}]})",
                           R"({"op": "unsubscribe", "subscriptionIds": [5]})"})
    EXPECT_FALSE(client_.receive(said, false)) << said;
  EXPECT_FALSE(client_.receive(std::string("\x01\x00\x00\x00\x00", 5), true)) << "a client's message";
  EXPECT_TRUE(client_.hears(1));
  EXPECT_FALSE(client_.hears(2));
}

TEST_F(FoxgloveClientTest, ASlowClientSkipsTheOldest) {
  subscribe(1, 1);
  subscribe(2, 2);
  push(2, 10, 200);
  for (std::size_t i = 0; i < 3 * FoxgloveClient::kMostWaiting; ++i)
    push(1, 10, static_cast<std::uint8_t>(i));
  EXPECT_EQ(client_.skipped(), 2 * FoxgloveClient::kMostWaiting);
  EXPECT_EQ(client_.next()->bytes->back(), 200) << "another channel's is there";
  EXPECT_EQ(client_.next()->bytes->back(), static_cast<std::uint8_t>(2 * FoxgloveClient::kMostWaiting));
  for (int i = 0; i < 100; ++i) push(1, FoxgloveClient::kMostWaitingBytes / 3);
  std::size_t bytes = 0;
  while (const auto next = client_.next()) bytes += next->bytes->size();
  EXPECT_LE(bytes, FoxgloveClient::kMostWaitingBytes + 100 * 13);
}

TEST_F(FoxgloveClientTest, AMessageLargerThanAllThatMayWaitIsSentAlone) {
  subscribe(1, 1);
  push(1, 2 * FoxgloveClient::kMostWaitingBytes);
  EXPECT_TRUE(client_.next());
}

}  // namespace
}  // namespace rds::viewer::foxglove
