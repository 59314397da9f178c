// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/web/request.hpp"

#include <algorithm>
#include <array>

namespace rds::viewer {
namespace {

constexpr std::string_view kTokenQuery = "token=";
constexpr std::string_view kBearer = "Bearer ";

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

bool is_token_character(char c) {
  return is_letter_or_digit(c) || c == '-' || c == '_';
}

bool is_path(std::string_view path) {
  return path.starts_with('/') && path.find("..") == std::string_view::npos &&
         path.find("//") == std::string_view::npos &&
         std::ranges::all_of(path, [](char c) { return is_token_character(c) || c == '.' || c == '/'; });
}

/// Takes the same time wherever they differ first.
bool is_same_secret(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    difference |= static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  return difference == 0;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// "localhost" of "localhost:8080", "[::1]" of "[::1]:8080".
std::string_view without_port(std::string_view host) {
  const auto colon = host.rfind(':');
  if (colon == std::string_view::npos || host.find(']', colon) != std::string_view::npos) return host;
  return host.substr(0, colon);
}

}  // namespace

std::optional<Target> parse_target(std::string_view target) {
  if (target.size() > kMostTargetBytes) return std::nullopt;
  const auto mark = target.find('?');
  const std::string_view path = target.substr(0, mark);
  if (!is_path(path)) return std::nullopt;
  if (mark == std::string_view::npos) return Target{std::string(path), {}};
  const std::string_view query = target.substr(mark + 1);
  if (query.empty()) return Target{std::string(path), {}};
  if (!query.starts_with(kTokenQuery)) return std::nullopt;
  const std::string_view token = query.substr(kTokenQuery.size());
  if (!std::ranges::all_of(token, is_token_character)) return std::nullopt;
  return Target{std::string(path), std::string(token)};
}

bool is_own_host(std::string_view host, const AccessRules& rules) {
  if (!rules.token.empty() || !rules.loopback) return true;
  static constexpr std::array<std::string_view, 3> kOwn{"localhost", "127.0.0.1", "[::1]"};
  return std::ranges::find(kOwn, without_port(host)) != kOwn.end();
}

bool is_allowed_origin(const Request& request, const AccessRules& rules) {
  if (request.origin.empty()) return true;
  if (request.origin == "http://" + request.host || request.origin == "https://" + request.host) return true;
  return std::ranges::find(rules.allowed_origins, request.origin) != rules.allowed_origins.end();
}

bool has_token(const Request& request, const Target& target, const AccessRules& rules) {
  if (rules.token.empty()) return true;
  const std::string_view authorization = request.authorization;
  const std::string_view bearer =
      authorization.starts_with(kBearer) ? authorization.substr(kBearer.size()) : std::string_view();
  return is_same_secret(target.token, rules.token) || is_same_secret(bearer, rules.token);
}

std::string choose_protocol(std::string_view offered, const std::vector<std::string>& known) {
  while (!offered.empty()) {
    const auto comma = offered.find(',');
    const std::string_view name = trimmed(offered.substr(0, comma));
    if (std::ranges::find(known, name) != known.end()) return std::string(name);
    offered = comma == std::string_view::npos ? std::string_view() : offered.substr(comma + 1);
  }
  return {};
}

}  // namespace rds::viewer
