// SPDX-License-Identifier: Apache-2.0
#include "tests/hosts/wire/packet_port.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <arpa/inet.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

namespace rds::test {
namespace {

constexpr std::size_t kLargestFrame = 70'000;  // segments that are not cut yet
constexpr int kBufferBytes = 16 << 20;

template <class Value>
bool set(int descriptor, int level, int name, const Value& value) {
  return setsockopt(descriptor, level, name, &value, sizeof value) == 0;
}

}  // namespace

PacketPort::PacketPort(const std::string& interface)
    : descriptor_(socket(AF_PACKET, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  const int index = static_cast<int>(if_nametoindex(interface.c_str()));
  packet_mreq all{};
  all.mr_ifindex = index;
  all.mr_type = PACKET_MR_PROMISC;
  sockaddr_ll address{};
  address.sll_family = AF_PACKET;
  address.sll_protocol = htons(ETH_P_ALL);
  address.sll_ifindex = index;
  const bool open = descriptor_ >= 0 && index > 0 && set(descriptor_, SOL_PACKET, PACKET_VNET_HDR, 1) &&
                    set(descriptor_, SOL_PACKET, PACKET_IGNORE_OUTGOING, 1) &&
                    set(descriptor_, SOL_SOCKET, SO_RCVBUFFORCE, kBufferBytes) &&
                    set(descriptor_, SOL_SOCKET, SO_SNDBUFFORCE, kBufferBytes) &&
                    set(descriptor_, SOL_PACKET, PACKET_ADD_MEMBERSHIP, all) &&
                    bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  if (open) return;
  const std::string reason = std::strerror(errno);
  if (descriptor_ >= 0) close(descriptor_);
  throw std::runtime_error(interface + ": " + reason);
}

PacketPort::~PacketPort() {
  close(descriptor_);
}

std::optional<std::vector<std::uint8_t>> PacketPort::receive() {
  std::vector<std::uint8_t> frame(kLargestFrame);
  const ssize_t size = recv(descriptor_, frame.data(), frame.size(), 0);
  if (size <= 0) return std::nullopt;
  return std::vector<std::uint8_t>(frame.begin(), frame.begin() + size);
}

void PacketPort::send(const std::vector<std::uint8_t>& frame) {
  (void)::send(descriptor_, frame.data(), frame.size(), 0);
}

}  // namespace rds::test
