// SPDX-License-Identifier: Apache-2.0
#pragma once

// Boost.Beast, for the two sources of this folder alone: it compiles slowly.
#include <memory>
#include <set>
#include <string>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "services/viewer/server/web_server.hpp"

namespace rds::viewer {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Tcp = boost::asio::ip::tcp;
using Upgrade = http::request<http::empty_body>;

class WebSocketSession;

/// What the sessions of a server share; outlives them.
struct ServerState {
  WebApp& app;
  ServerLimits limits;
  ServerCounts counts{};
  std::size_t open = 0;  // connections now
  std::set<WebSocketSession*> clients{};
};

/// True for what a client does that leaves, or is silent, in whatever way; all else is malformed.
inline bool is_departure(const beast::error_code& error) {
  namespace net = boost::asio::error;
  return error == websocket::error::closed || error == http::error::end_of_stream ||
         error == beast::error::timeout || error == net::eof || error == net::connection_reset ||
         error == net::broken_pipe || error == net::not_connected || error == net::operation_aborted;
}

/// Counts a connection as long as it is open.
class OpenConnection {
 public:
  explicit OpenConnection(ServerState& state) : state_(state) { ++state_.open; }
  ~OpenConnection() { --state_.open; }
  OpenConnection(const OpenConnection&) = delete;
  OpenConnection& operator=(const OpenConnection&) = delete;

 private:
  ServerState& state_;
};

/// One WebSocket: reads what the client says, and sends one message after the other.
class WebSocketSession : public std::enable_shared_from_this<WebSocketSession> {
 public:
  WebSocketSession(ServerState& state, std::shared_ptr<OpenConnection> connection, beast::tcp_stream stream,
                   Opening opening);
  ~WebSocketSession();
  WebSocketSession(const WebSocketSession&) = delete;
  WebSocketSession& operator=(const WebSocketSession&) = delete;

  void accept(const Upgrade& request);
  void pump();

 private:
  void read();
  void take();
  void end(const beast::error_code& error);

  ServerState& state_;
  std::shared_ptr<OpenConnection> connection_;
  websocket::stream<beast::tcp_stream> socket_;
  std::unique_ptr<Conversation> conversation_;
  std::string protocol_;
  beast::flat_buffer received_;
  SharedBytes sending_;
  bool is_open_ = false;
};

}  // namespace rds::viewer
