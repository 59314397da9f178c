// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/server/web_server.hpp"

#include <deque>
#include <set>

#include <gmock/gmock.h>

#include "tests/unit/services/viewer/web_peer.hpp"

namespace rds::viewer {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using namespace std::chrono_literals;
using test::client_frame;
using test::upgrade_request;
using test::WebPeer;

/// Counts what was sent, and has always more to send.
class Endless final : public Conversation {
 public:
  bool receive(std::string_view message, bool /*binary*/) override {
    heard.emplace_back(message);
    return message != "nonsense";
  }
  std::optional<Outgoing> next() override {
    if (left == 0) return std::nullopt;
    --left;
    ++sent;
    return Outgoing{std::make_shared<const Bytes>(size, 'x')};
  }
  std::vector<std::string> heard;
  std::size_t left = 0;
  std::size_t sent = 0;
  std::size_t size = 100;
};

class WebServerTest : public ::testing::Test, private WebApp {
 protected:
  /// Serves until it holds, at most two seconds.
  template <class Condition>
  bool serve_until(Condition holds) {
    for (int i = 0; i < 400 && !holds(); ++i) server_.serve_for(5ms);
    return holds();
  }
  std::string answer(const std::string& request) {
    WebPeer peer(server_.port());
    peer.send(request);
    std::string all;
    serve_until([&] {
      all += peer.receive();
      return peer.closed() || all.ends_with("\r\n\r\nfile of /") || all.ends_with("\r\n\r\n");
    });
    return all;
  }
  /// Opens a WebSocket. @return the conversation at the server's side.
  Endless* open(WebPeer& peer) {
    peer.send(upgrade_request("test"));
    std::string all;
    const std::size_t before = server_.counts().clients;
    EXPECT_TRUE(serve_until([&] {
      all += peer.receive();
      return all.find("\r\n\r\n") != std::string::npos;
    }));
    EXPECT_THAT(all, StartsWith("HTTP/1.1 101 "));
    EXPECT_THAT(all, HasSubstr("Sec-WebSocket-Protocol: test\r\n"));
    EXPECT_EQ(server_.counts().clients, before + 1);
    return newest_;
  }

  HttpAnswer get(const Request& request) override {
    if (request.target != "/") return {.status = 404, .text = "none"};
    return {.file = "file of /"};
  }
  Opening open(const Request& request) override {
    if (request.protocols != "test") return {nullptr, {}, {.status = 400, .text = "no such protocol"}};
    auto conversation = std::make_unique<Endless>();
    newest_ = conversation.get();
    open_.insert(newest_);
    return {std::move(conversation), "test", {}};
  }
  void close(Conversation& conversation) override { open_.erase(static_cast<Endless*>(&conversation)); }

  Endless* newest_ = nullptr;
  std::set<Endless*> open_;
  WebServer server_{
      "127.0.0.1",
      0,
      {.connections = 8, .clients = 3, .message_bytes = 1000, .request_time = 1s, .silence = 1s},
      *this};
};

TEST_F(WebServerTest, ServesFilesAndNothingElse) {
  const std::string whole = answer("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
  EXPECT_THAT(whole, StartsWith("HTTP/1.1 200 OK"));
  EXPECT_THAT(whole, HasSubstr("Content-Security-Policy: default-src 'self'"));
  EXPECT_THAT(whole, HasSubstr("\r\n\r\nfile of /"));
  const std::string head = answer("HEAD / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
  EXPECT_THAT(head, HasSubstr("Content-Length: 9"));
  EXPECT_THAT(head, ::testing::Not(HasSubstr("file of /")));
  EXPECT_THAT(answer("GET /x HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(answer("POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 0\r\n\r\n"),
              StartsWith("HTTP/1.1 405"));
  EXPECT_EQ(server_.counts().malformed, 0U);
}

TEST_F(WebServerTest, ClosesAndCountsWhatIsNoHttp) {
  std::uint64_t malformed = 0;
  for (const std::string& bytes :
       {std::string("\x16\x03\x01\x02\x00\x01"), std::string("GET / HTTP/9.9\r\n\r\n"),
        std::string("nonsense\r\n\r\n"), "GET / HTTP/1.1\r\nX: " + std::string(9000, 'x') + "\r\n\r\n",
        std::string("GET / HTTP/1.1\r\nContent-Length: 99999999999\r\n\r\n")}) {
    answer(bytes);
    EXPECT_EQ(server_.counts().malformed, ++malformed) << bytes.substr(0, 40);
  }
  EXPECT_THAT(answer("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"), StartsWith("HTTP/1.1 200 OK"));
}

TEST_F(WebServerTest, ARequestThatNeverEndsIsClosed) {
  WebPeer peer(server_.port());
  peer.send("GET / HTTP/1.1\r\nHo");
  EXPECT_TRUE(serve_until([&] {
    peer.receive();
    return peer.closed();
  }));
}

TEST_F(WebServerTest, RefusesMoreConnectionsAndClientsThanItSays) {
  std::deque<WebPeer> clients;
  for (int i = 0; i < 3; ++i) open(clients.emplace_back(server_.port()));
  EXPECT_THAT(answer(upgrade_request("test")), StartsWith("HTTP/1.1 503"));
  std::deque<WebPeer> idle;
  for (int i = 0; i < 20; ++i) idle.emplace_back(server_.port());
  EXPECT_TRUE(serve_until([&] {
    std::size_t closed = 0;
    for (WebPeer& peer : idle) {
      peer.receive();
      closed += peer.closed() ? 1 : 0;
    }
    return closed >= 15;
  }));
  EXPECT_GE(server_.counts().refused, 16U);
}

TEST_F(WebServerTest, ProtocolsThatItDoesNotSpeakAreRefused) {
  EXPECT_THAT(answer(upgrade_request("mqtt")), StartsWith("HTTP/1.1 400"));
  EXPECT_EQ(server_.counts().clients, 0U);
}

TEST_F(WebServerTest, AClientThatDoesNotWaitForTheAnswerIsRefused) {
  EXPECT_THAT(answer(upgrade_request("test") + client_frame("hello")), StartsWith("HTTP/1.1 400"));
}

TEST_F(WebServerTest, SaysWhatThereIsToEachClientAndHearsIt) {
  WebPeer peer(server_.port());
  Endless* conversation = open(peer);
  peer.send(client_frame("hello") + client_frame("nonsense"));
  EXPECT_TRUE(serve_until([&] { return conversation->heard.size() == 2; }));
  EXPECT_EQ(conversation->heard[0], "hello");
  EXPECT_EQ(server_.counts().refused_messages, 1U);
  conversation->left = 3;
  server_.pump();
  std::string got;
  EXPECT_TRUE(serve_until([&] {
    got += peer.receive();
    return got.size() == 3 * 102;
  }));
  EXPECT_EQ(got.substr(0, 2), "\x82\x64");  // binary, 100 bytes
}

TEST_F(WebServerTest, AStoppedClientGetsLittleAndKeepsNobodyWaiting) {
  WebPeer stopped(server_.port());
  Endless* to_stopped = open(stopped);
  WebPeer reader(server_.port());
  Endless* to_reader = open(reader);
  for (Endless* conversation : {to_stopped, to_reader}) {
    conversation->size = 100000;
    conversation->left = 200;
  }
  server_.pump();
  std::size_t got = 0;
  EXPECT_TRUE(serve_until([&] {
    got += reader.receive().size();
    return got >= 200 * 100000;
  }));
  EXPECT_EQ(to_reader->sent, 200U);
  EXPECT_LT(to_stopped->sent, 150U) << "what the sockets of the kernel hold, and one more";
}

TEST_F(WebServerTest, ClosesOneConnectionForABadFrame) {
  WebPeer good(server_.port());
  Endless* conversation = open(good);
  std::uint64_t malformed = 0;
  for (const std::string& bad :
       {std::string("\x81\x05hello"), std::string("\xff\x80\0\0\0\0", 6), std::string("\x83\x80\0\0\0\0", 6),
        client_frame(std::string(2000, 'x')),
        std::string("\x82\xff\xff\xff\xff\xff\xff\xff\xff\xff\0\0\0\0", 14), client_frame("\xff\xfe\xfd")}) {
    {
      WebPeer peer(server_.port());
      open(peer);
      peer.send(bad);
      EXPECT_TRUE(serve_until([&] {
        peer.receive();
        return peer.closed();
      }));
    }
    EXPECT_TRUE(serve_until([&] { return open_.size() == 1; }));
    EXPECT_EQ(server_.counts().malformed, ++malformed);
  }
  EXPECT_TRUE(serve_until([&] { return open_.size() == 1; }));
  good.send(client_frame("still here"));
  EXPECT_TRUE(serve_until([&] { return conversation->heard.size() == 1; }));
}

TEST_F(WebServerTest, AHalfOpenWebSocketGoes) {
  WebPeer peer(server_.port());
  open(peer);
  peer.send("\x81");  // and never more: no answer to pings either
  EXPECT_TRUE(serve_until([&] { return open_.empty(); }));
}

TEST(WebServer, SaysWhichAddressCannotBeHad) {
  class Nothing : public WebApp {
    HttpAnswer get(const Request&) override { return {}; }
    Opening open(const Request&) override { return {}; }
    void close(Conversation&) override {}
  } app;
  const WebServer first("127.0.0.1", 0, {}, app);
  try {
    const WebServer second("127.0.0.1", first.port(), {}, app);
    ADD_FAILURE() << "twice on one port";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("Address already in use"));
  }
}

}  // namespace
}  // namespace rds::viewer
