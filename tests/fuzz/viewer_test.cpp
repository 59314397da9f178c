// SPDX-License-Identifier: Apache-2.0
// What clients of the viewer send, spoiled: addresses, messages, and bytes on its port.
#include <gmock/gmock.h>

#include "services/viewer/core/board/page_client.hpp"
#include "services/viewer/core/foxglove/foxglove_client.hpp"
#include "services/viewer/core/web/request.hpp"
#include "services/viewer/server/web_server.hpp"
#include "tests/fuzz/feed.hpp"
#include "tests/unit/services/viewer/web_peer.hpp"

namespace rds::fuzz {
namespace {

using viewer::test::client_frame;
using viewer::test::upgrade_request;
using viewer::test::WebPeer;

Bytes bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}
std::string_view text_of(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// JSON is parsed into nodes: some 50 bytes each, of which a text of n bytes has at most n.
std::size_t bound(std::size_t bytes) {
  return 64 * 1024 + 128 * bytes;
}

TEST(Viewer, AddressesOfAnyone) {
  feed(1,
       {bytes_of("/"), bytes_of("/socket?token=0123456789abcdef"), bytes_of("/vendor/three/three.module.js")},
       bound, [](const Bytes& bytes) {
         const auto target = viewer::parse_target(text_of(bytes));
         if (!target) return false;
         EXPECT_EQ(target->path.find(".."), std::string::npos);
         EXPECT_EQ(target->path.find_first_of(std::string("\\%\0 \n", 5)), std::string::npos);
         EXPECT_TRUE(target->path.starts_with('/'));
         return true;
       });
}

TEST(Viewer, MessagesOfAnyPage) {
  const viewer::Board board;
  feed(1,
       {bytes_of(R"({"picture": true})"), bytes_of(R"({"command": "save", "argument": "kitchen"})"),
        bytes_of(R"({"command": "reset"})")},
       bound, [&](const Bytes& bytes) {
         viewer::PageClient client(board);
         client.allow([](const viewer::PageCommand& command) {
           EXPECT_THAT(command.verb, ::testing::AnyOf("pause", "resume", "reset", "save"));
           EXPECT_EQ(command.argument.find('/') == std::string::npos || command.verb != "save", true);
         });
         return client.receive(text_of(bytes), false);
       });
}

TEST(Viewer, MessagesOfAnyFoxgloveClient) {
  const std::vector<viewer::foxglove::Channel> channels{{1, "/tf", "tf2_msgs/msg/TFMessage", ""},
                                                        {2, "/x", "y", ""}};
  feed(
      1,
      {bytes_of(
           R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 2}, {"id": 3, "channelId": 1}]})"),
       bytes_of(R"({"op": "unsubscribe", "subscriptionIds": []})")},
      bound, [&](const Bytes& bytes) {
        viewer::foxglove::FoxgloveClient client(channels, "",
                                                [](auto&, std::uint32_t channel) { EXPECT_LE(channel, 2U); });
        return client.receive(text_of(bytes), false);
      });
}

/// Speaks with one page at a time.
class Port : private viewer::WebApp {
 public:
  /// Bytes of a client that waits for the answer to its request, if it is one, and leaves in the end.
  bool take(const Bytes& bytes) {
    const std::uint64_t before = server_.counts().malformed;
    const std::string all(text_of(bytes));
    const std::size_t blank = all.find("\r\n\r\n");
    const std::size_t request = blank == std::string::npos ? all.size() : blank + 4;
    {
      WebPeer peer(server_.port());
      for (const std::string& part : {all.substr(0, request), all.substr(request)}) {
        peer.send(part);
        for (int i = 0; i < 3; ++i) server_.serve_what_is_due();
        peer.receive();
      }
    }
    for (int i = 0; i < 3; ++i) server_.serve_what_is_due();
    return server_.counts().malformed == before;
  }
  [[nodiscard]] const viewer::ServerCounts& counts() const { return server_.counts(); }
  void serve() { server_.serve_for(std::chrono::milliseconds(20)); }

 private:
  viewer::HttpAnswer get(const viewer::Request& request) override {
    return {.status = viewer::parse_target(request.target) ? 200U : 400U, .text = "x"};
  }
  viewer::Opening open(const viewer::Request& request) override {
    if (request.protocols != viewer::kPageProtocol) return {nullptr, {}, {.status = 400, .text = "no"}};
    return {std::make_unique<viewer::PageClient>(board_), viewer::kPageProtocol, {}};
  }
  void close(viewer::Conversation&) override {}

  viewer::Board board_;
  viewer::WebServer server_{"127.0.0.1", 0, {.message_bytes = 4096}, *this};
};

TEST(Viewer, BytesOnItsPort) {
  Port port;
  const std::string page = upgrade_request(viewer::kPageProtocol);
  feed(
      1,
      {bytes_of("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"),
       bytes_of(page + client_frame(R"({"picture": true})")),
       bytes_of(page + client_frame("a", 0x01) + client_frame("b", 0x80) + client_frame("", 0x88)),
       bytes_of(page + client_frame(std::string(3000, 'x'), 0x82))},
      [](std::size_t bytes) { return (std::size_t{1} << 20) + 128 * bytes; },
      [&](const Bytes& bytes) { return port.take(bytes); });
  for (int i = 0; i < 100 && port.counts().clients > 0; ++i) port.serve();
  EXPECT_EQ(port.counts().clients, 0U);
  EXPECT_GT(port.counts().malformed, 0U);
  EXPECT_TRUE(port.take(bytes_of("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")));
}

}  // namespace
}  // namespace rds::fuzz
