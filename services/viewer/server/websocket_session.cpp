// SPDX-License-Identifier: Apache-2.0
#include <exception>

#include <spdlog/spdlog.h>

#include "services/viewer/server/sessions.hpp"

namespace rds::viewer {
namespace {

constexpr int kSocketBufferBytes = 256 * 1024;  // of the kernel, for what a client has not taken
constexpr std::chrono::seconds kHandshakeTime{10};

}  // namespace

WebSocketSession::WebSocketSession(ServerState& state, std::shared_ptr<OpenConnection> connection,
                                   beast::tcp_stream stream, Opening opening)
    : state_(state),
      connection_(std::move(connection)),
      socket_(std::move(stream)),
      conversation_(std::move(opening.conversation)),
      protocol_(std::move(opening.protocol)),
      received_(state.limits.message_bytes) {
  state_.clients.insert(this);
  state_.counts.clients = state_.clients.size();
}

WebSocketSession::~WebSocketSession() {
  state_.clients.erase(this);
  state_.counts.clients = state_.clients.size();
  state_.app.close(*conversation_);
}

void WebSocketSession::accept(const Upgrade& request) {
  beast::error_code ignored;
  socket_.next_layer().socket().set_option(boost::asio::socket_base::send_buffer_size(kSocketBufferBytes),
                                           ignored);
  socket_.next_layer().socket().set_option(Tcp::no_delay(true), ignored);
  socket_.next_layer().expires_never();  // the WebSocket has times of its own
  socket_.set_option(websocket::stream_base::timeout{kHandshakeTime, state_.limits.silence, true});
  socket_.set_option(websocket::stream_base::decorator([this](websocket::response_type& response) {
    response.set(http::field::sec_websocket_protocol, protocol_);
  }));
  socket_.read_message_max(state_.limits.message_bytes);
  socket_.auto_fragment(false);
  socket_.async_accept(request, [self = shared_from_this()](const beast::error_code& error) {
    if (error) return self->end(error);
    self->is_open_ = true;
    self->read();
    self->pump();
  });
}

void WebSocketSession::read() {
  socket_.async_read(received_, [self = shared_from_this()](const beast::error_code& error, std::size_t) {
    if (error) return self->end(error);
    self->take();
  });
}

void WebSocketSession::take() {
  const auto data = received_.data();
  const std::string_view message(static_cast<const char*>(data.data()), data.size());
  try {
    if (!conversation_->receive(message, socket_.got_binary())) ++state_.counts.refused_messages;
  } catch (const std::exception& e) {
    spdlog::warn("a client's message: {}", e.what());
    ++state_.counts.refused_messages;
  }
  received_.consume(received_.size());
  pump();
  read();
}

void WebSocketSession::pump() {
  if (!is_open_ || sending_) return;
  auto next = conversation_->next();
  if (!next) return;
  sending_ = std::move(next->bytes);
  socket_.binary(next->binary);
  socket_.async_write(boost::asio::buffer(*sending_),
                      [self = shared_from_this()](const beast::error_code& error, std::size_t) {
                        self->sending_.reset();
                        if (error) return self->end(error);
                        self->pump();
                      });
}

/// The other operation under way fails with the closed socket, and with the last one the session goes.
void WebSocketSession::end(const beast::error_code& error) {
  if (!is_departure(error) && is_open_) ++state_.counts.malformed;
  is_open_ = false;
  beast::get_lowest_layer(socket_).close();
}

}  // namespace rds::viewer
