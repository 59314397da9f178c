// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/listen_address.hpp"

#include <charconv>
#include <string_view>

#include <arpa/inet.h>
#include <fmt/format.h>

namespace rds::viewer {
namespace {

bool is_ip(const std::string& address) {
  in6_addr unused{};
  return inet_pton(AF_INET, address.c_str(), &unused) == 1 ||
         inet_pton(AF_INET6, address.c_str(), &unused) == 1;
}

}  // namespace

std::string ListenAddress::url() const {
  const bool v6 = address.find(':') != std::string::npos;
  return fmt::format("http://{}{}{}:{}/", v6 ? "[" : "", address, v6 ? "]" : "", port);
}

tl::expected<ListenAddress, std::string> parse_listen_address(const std::string& text) {
  const auto colon = text.rfind(':');
  ListenAddress listen{"127.0.0.1"};
  if (colon != std::string::npos) listen.address = text.substr(0, colon);
  if (listen.address == "localhost") listen.address = "127.0.0.1";
  if (listen.address.starts_with('[') && listen.address.ends_with(']'))
    listen.address = listen.address.substr(1, listen.address.size() - 2);
  const std::string_view port = std::string_view(text).substr(colon == std::string::npos ? 0 : colon + 1);
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), listen.port);
  if (error != std::errc() || end != port.data() + port.size() || !is_ip(listen.address))
    return tl::unexpected(std::string("ADDRESS:PORT with an IP address of this machine, or a port"));
  return listen;
}

}  // namespace rds::viewer
