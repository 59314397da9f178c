// SPDX-License-Identifier: Apache-2.0
#include "tests/support/notify_socket.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace rds::test {
namespace {
using Clock = std::chrono::steady_clock;
constexpr std::size_t kMaxMessage = 4096;
}  // namespace

NotifySocket::NotifySocket() : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = path();
  if (name.size() >= sizeof(address.sun_path)) throw std::runtime_error(name + ": too long for a socket");
  std::ranges::copy(name, address.sun_path);
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error(name + ": no socket can be made");
}

NotifySocket::~NotifySocket() {
  close(socket_);
}

std::vector<std::string> NotifySocket::read_until(const std::string& text, std::chrono::milliseconds limit) {
  std::vector<std::string> messages;
  const auto deadline = Clock::now() + limit;
  while (Clock::now() < deadline) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    pollfd waiting{.fd = socket_, .events = POLLIN, .revents = 0};
    if (poll(&waiting, 1, static_cast<int>(left.count()) + 1) <= 0) break;
    std::array<char, kMaxMessage> buffer{};
    const auto size = recv(socket_, buffer.data(), buffer.size(), 0);
    if (size < 0) break;
    messages.emplace_back(buffer.data(), static_cast<std::size_t>(size));
    if (!text.empty() && messages.back().find(text) != std::string::npos) break;
  }
  return messages;
}

std::vector<std::string> NotifySocket::read_for(std::chrono::milliseconds time) {
  return read_until("", time);
}

}  // namespace rds::test
