// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace rds::viewer::test {

/// A client's bare TCP socket, which never waits: the server runs on the same thread.
class WebPeer {
 public:
  explicit WebPeer(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
    ::fcntl(socket_, F_SETFL, O_NONBLOCK);
  }
  ~WebPeer() { ::close(socket_); }
  WebPeer(const WebPeer&) = delete;
  WebPeer& operator=(const WebPeer&) = delete;

  /// @return how many bytes the kernel took.
  std::size_t send(const std::string& bytes) {
    const auto sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    return sent < 0 ? 0 : static_cast<std::size_t>(sent);
  }
  /// What has come since; empty: nothing.
  std::string receive() {
    std::string all;
    char part[65536];
    for (;;) {
      const auto got = ::recv(socket_, part, sizeof(part), 0);
      if (got == 0 || (got < 0 && errno != EAGAIN && errno != EWOULDBLOCK)) closed_ = true;
      if (got <= 0) return all;
      all.append(part, static_cast<std::size_t>(got));
    }
  }
  [[nodiscard]] bool connected() const { return connected_; }
  /// Whether receive() has met the end.
  [[nodiscard]] bool closed() const { return closed_; }

 private:
  int socket_;
  bool connected_ = false;
  bool closed_ = false;
};

/// A client's WebSocket frame with a mask of zeros. @param first  FIN and opcode: 0x81 is text.
inline std::string client_frame(const std::string& payload, unsigned char first = 0x81) {
  std::string frame(1, static_cast<char>(first));
  const std::size_t size = payload.size();
  if (size < 126) {
    frame += static_cast<char>(0x80U | size);
  } else {
    frame += static_cast<char>(0x80U | (size < 65536 ? 126U : 127U));
    for (int shift = size < 65536 ? 8 : 56; shift >= 0; shift -= 8)
      frame += static_cast<char>(size >> shift & 255U);
  }
  return frame + std::string(4, '\0') + payload;
}

inline std::string upgrade_request(const std::string& protocol, const std::string& more = "") {
  return "GET /socket HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: "
         "13\r\nSec-WebSocket-Protocol: " +
         protocol + "\r\n" + more + "\r\n";
}

}  // namespace rds::viewer::test
