// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <tl/expected.hpp>

namespace rds::viewer {

/// Where the page is served.
struct ListenAddress {
  std::string address;  // of an interface: IPv4 or IPv6, without brackets
  std::uint16_t port = 0;

  /// Only programs of this machine reach it.
  [[nodiscard]] bool is_loopback() const { return address.starts_with("127.") || address == "::1"; }
  /// "http://127.0.0.1:8080/"
  [[nodiscard]] std::string url() const;
};

/// Reads "127.0.0.1:8080", "[::1]:8080", "localhost:8080", "0.0.0.0:8080" or a port alone.
/// @return or what was expected.
tl::expected<ListenAddress, std::string> parse_listen_address(const std::string& text);

}  // namespace rds::viewer
