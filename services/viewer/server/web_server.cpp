// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/server/web_server.hpp"

#include <optional>
#include <stdexcept>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/version.hpp>
#include <fmt/format.h>

#include "services/viewer/server/sessions.hpp"

namespace rds::viewer {
namespace {

constexpr std::uint32_t kMostHeaderBytes = 8 * 1024;
constexpr std::chrono::milliseconds kAcceptAgain{100};  // after "too many open files"

/// Nothing of another site, and no code or style but the files of this server.
constexpr const char* kContentPolicy =
    "default-src 'self'; img-src 'self' blob: data:; connect-src 'self' ws: wss:; frame-ancestors 'none'; "
    "base-uri 'none'; form-action 'none'";

std::string text_of(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

Request request_of(const Upgrade& message) {
  return {text_of(message.target()), text_of(message[http::field::host]),
          text_of(message[http::field::origin]), text_of(message[http::field::authorization]),
          text_of(message[http::field::sec_websocket_protocol])};
}

/// One connection, until it becomes a WebSocket.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(ServerState& state, Tcp::socket socket)
      : state_(state),
        connection_(std::make_shared<OpenConnection>(state)),
        stream_(std::move(socket)),
        received_(2 * kMostHeaderBytes) {}

  void read() {
    parser_.emplace();
    parser_->header_limit(kMostHeaderBytes);
    parser_->body_limit(0);
    stream_.expires_after(state_.limits.request_time);
    http::async_read(
        stream_, received_, *parser_,
        [self = shared_from_this()](const beast::error_code& error, std::size_t) { self->take(error); });
  }

 private:
  void take(const beast::error_code& error) {
    if (error && !is_departure(error)) ++state_.counts.malformed;
    if (error) return;
    const Upgrade message = parser_->release();
    if (websocket::is_upgrade(message)) return open(message);
    if (message.method() == http::verb::get || message.method() == http::verb::head)
      return answer(message, state_.app.get(request_of(message)));
    answer(message, {.status = 405, .text = "expected GET\n"});
  }

  void open(const Upgrade& message) {
    if (received_.size() > 0)  // RFC 6455, 4.1: a client waits for the answer before it says more
      return answer(message, {.status = 400, .text = "bytes before the answer\n"});
    if (state_.clients.size() >= state_.limits.clients)
      return answer(message, {.status = 503, .text = "too many clients\n"});
    Opening opening = state_.app.open(request_of(message));
    if (!opening.conversation) return answer(message, std::move(opening.refusal));
    std::make_shared<WebSocketSession>(state_, connection_, std::move(stream_), std::move(opening))
        ->accept(message);
  }

  void answer(const Upgrade& message, HttpAnswer said) {
    if (said.status >= 400) ++state_.counts.refused;
    said_ = std::move(said);
    const std::string_view body = said_.file.empty() ? std::string_view(said_.text) : said_.file;
    answer_ = {};
    answer_.version(message.version());
    answer_.result(said_.status);
    answer_.keep_alive(message.keep_alive() && said_.status < 400);
    answer_.set(http::field::content_type,
                boost::beast::string_view(said_.content_type.data(), said_.content_type.size()));
    answer_.set(http::field::cache_control, "no-cache");
    answer_.set("Content-Security-Policy", kContentPolicy);
    answer_.set("X-Content-Type-Options", "nosniff");
    answer_.set("Referrer-Policy", "no-referrer");
    answer_.content_length(body.size());
    if (message.method() != http::verb::head) answer_.body() = {body.data(), body.size()};
    http::async_write(stream_, answer_,
                      [self = shared_from_this()](const beast::error_code& error, std::size_t) {
                        if (error) return;
                        if (self->answer_.keep_alive()) return self->read();
                        beast::error_code ignored;
                        self->stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
                      });
  }

  ServerState& state_;
  std::shared_ptr<OpenConnection> connection_;
  beast::tcp_stream stream_;
  beast::flat_buffer received_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  HttpAnswer said_;
  http::response<http::span_body<const char>> answer_;
};

}  // namespace

class WebServer::Listener {
 public:
  Listener(const std::string& address, std::uint16_t port, const ServerLimits& limits, WebApp& app)
      : state_{app, limits}, acceptor_(context_), again_(context_) {
    try {
      const Tcp::endpoint endpoint(boost::asio::ip::make_address(address), port);
      acceptor_.open(endpoint.protocol());
      acceptor_.set_option(Tcp::acceptor::reuse_address(true));
      acceptor_.bind(endpoint);
      acceptor_.listen();
    } catch (const boost::system::system_error& e) {
      throw std::runtime_error(
          fmt::format("{}:{}: cannot be listened on: {}", address, port, e.code().message()));
    }
    accept();
  }

  void accept() {
    acceptor_.async_accept([this](const beast::error_code& error, Tcp::socket socket) {
      if (error == boost::asio::error::operation_aborted) return;
      if (error) return accept_later();
      ++state_.counts.connections;
      if (state_.open >= state_.limits.connections)
        ++state_.counts.refused;  // the socket closes here
      else
        std::make_shared<HttpSession>(state_, std::move(socket))->read();
      accept();
    });
  }

  void accept_later() {
    again_.expires_after(kAcceptAgain);
    again_.async_wait([this](const beast::error_code& error) {
      if (!error) accept();
    });
  }

  ServerState state_;  // before the context, whose sessions use it
  boost::asio::io_context context_{1};
  Tcp::acceptor acceptor_;
  boost::asio::steady_timer again_;
};

WebServer::WebServer(const std::string& address, std::uint16_t port, const ServerLimits& limits, WebApp& app)
    : listener_(std::make_unique<Listener>(address, port, limits, app)) {}

WebServer::~WebServer() = default;

void WebServer::serve_for(std::chrono::milliseconds duration) {
  listener_->context_.run_for(duration);
}

void WebServer::serve_what_is_due() {
  listener_->context_.poll();
}

void WebServer::post(std::function<void()> task) {
  boost::asio::post(listener_->context_, std::move(task));
}

void WebServer::pump() {
  for (WebSocketSession* client : listener_->state_.clients) client->pump();
}

std::uint16_t WebServer::port() const {
  return listener_->acceptor_.local_endpoint().port();
}

const ServerCounts& WebServer::counts() const {
  return listener_->state_.counts;
}

}  // namespace rds::viewer
