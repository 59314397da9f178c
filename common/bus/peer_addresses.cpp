// SPDX-License-Identifier: Apache-2.0
#include "common/bus/peer_addresses.hpp"

#include <array>
#include <memory>
#include <sstream>

#include <arpa/inet.h>
#include <netdb.h>

#include "common/bus/participant.hpp"

namespace rds::bus {
namespace {

std::string address_of(const std::string& name) {
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (const int error = getaddrinfo(name.c_str(), nullptr, &wanted, &found); error != 0)
    throw BusError("peer '" + name + "': " + gai_strerror(error));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owned(found, &freeaddrinfo);
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(found->ai_addr)->sin_addr, text.data(),
            text.size());
  return text.data();
}

}  // namespace

std::vector<std::string> peer_addresses(const std::string& names) {
  std::vector<std::string> addresses;
  std::istringstream list(names);
  for (std::string name; std::getline(list, name, ',');)
    addresses.push_back(name.find('/') == std::string::npos ? address_of(name) : name);
  return addresses;
}

}  // namespace rds::bus
