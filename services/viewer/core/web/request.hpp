// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rds::viewer {

/// What of an HTTP request is looked at.
struct Request {
  std::string target;  // "/app.js?token=…", as the client sent it
  std::string host;    // header fields; empty where they are missing
  std::string origin;
  std::string authorization;
  std::string protocols;  // Sec-WebSocket-Protocol
};

/// A target that was understood.
struct Target {
  std::string path;   // begins with '/', has no "..", no "//" and only letters, digits and "-_./"
  std::string token;  // of the query; empty without
};

inline constexpr std::size_t kMostTargetBytes = 512;

/// @return nullopt for what no page of ours asks for: too long, a path that is not as above, another query
/// than token=TOKEN.
std::optional<Target> parse_target(std::string_view target);

/// Who may connect.
struct AccessRules {
  bool loopback = true;                      // the port is one of 127.0.0.1 or ::1
  std::string token;                         // empty: none is asked for
  std::vector<std::string> allowed_origins;  // besides the page's own
};

/// True unless a page of another site may be behind it: the browser was led to this port by a name that is
/// not this machine's (DNS rebinding). Any name will do where a token is asked for.
bool is_own_host(std::string_view host, const AccessRules& rules);

/// True for programs that are no browser (no Origin), for this server's own page, and for those allowed.
bool is_allowed_origin(const Request& request, const AccessRules& rules);

/// True if no token is needed, or the right one is in the query, or in "Authorization: Bearer TOKEN".
bool has_token(const Request& request, const Target& target, const AccessRules& rules);

/// The first of the protocols that the client offers and that is known; empty if none is.
std::string choose_protocol(std::string_view offered, const std::vector<std::string>& known);

}  // namespace rds::viewer
