// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/links/link_notices.hpp"

#include <algorithm>
#include <array>
#include <regex>
#include <utility>

#include <fmt/format.h>

namespace rds::bus::detail {
namespace {

/// Different sentences at most, as strangers can cause them.
constexpr std::size_t kMostSaid = 64;

constexpr std::string_view kNotReached = "Unable to connect to configured peer ";
constexpr std::string_view kReached = "Successfully connected to configured peer ";
constexpr std::string_view kEndOfReason = ". Retry in ";
/// What Zenoh appends to whatever an encrypted link was refused for.
constexpr std::string_view kHint = ". Hint: increase the system open file limit.";
constexpr std::string_view kNotListed = " did not match any configured ACL subject";

/// Parts of errors, as rustls and Zenoh write them, in plain words.
constexpr std::array<std::pair<std::string_view, std::string_view>, 11> kPlainWords{{
    {"invalid peer certificate: BadSignature", "its certificate is of another authority"},
    {"invalid peer certificate: UnknownIssuer", "its certificate is of another authority"},
    {"invalid peer certificate: Expired", "its certificate has expired"},
    {"invalid peer certificate: certificate expired", "its certificate has expired"},
    {"alert: DecryptError", "the other side takes our certificate for one of another authority"},
    {"alert: UnknownCA", "the other side takes our certificate for one of another authority"},
    {"alert: CertificateExpired", "the other side says that our certificate has expired"},
    {"peer sent no certificates", "the other side shows no certificate"},
    {"(reason 2) in response to an InitSyn", "it refuses our version of Zenoh's protocol"},
    {"InvalidContentType", "the other side does not encrypt"},
    {"remote certificate chain expired", "its certificate has expired"},
}};

std::string without_places(std::string_view error) {
  static const std::regex place(R"( at [^ \]]*\.rs:\d+\.?)");
  return std::regex_replace(std::string(error), place, "");
}

/// "Can not create a new TCP link bound to ...: [127.0.0.1:7447: Connection refused]" names the address
/// twice.
std::string innermost(std::string error) {
  const std::size_t bound = error.find(" link bound to ");
  if (bound == std::string::npos) return error;
  if (const std::size_t open = error.find(": [", bound); open != std::string::npos) {
    error = error.substr(open + 3, error.rfind(']') - open - 3);
    return error.substr(error.rfind(": ") == std::string::npos ? 0 : error.rfind(": ") + 2);
  }
  const std::size_t cause = error.find("): ", bound);
  return cause == std::string::npos ? error : error.substr(cause + 3);
}

}  // namespace

std::string reason_of(std::string_view error) {
  for (const auto& [part, words] : kPlainWords)
    if (error.find(part) != std::string_view::npos) return std::string(words);
  std::string reason = innermost(without_places(error));
  while (reason.ends_with('.')) reason.pop_back();
  return reason;
}

void LinkNotices::ignore(const std::string& endpoint) {
  const std::lock_guard lock(mutex_);
  ignored_.insert(endpoint);
}

void LinkNotices::take(std::string_view line) {
  if (line.starts_with(kNotReached)) return take_not_reached(line.substr(kNotReached.size()));
  if (line.starts_with(kReached)) return take_reached(line.substr(kReached.size()));
  if (line.ends_with(kHint))
    return say_once("a program is refused: " + reason_of(line.substr(0, line.size() - kHint.size())));
  if (line.find("remote certificate chain expired") != std::string_view::npos)
    return say_once("a link is closed: " + reason_of(line));
  if (const std::size_t end = line.find(kNotListed); end != std::string_view::npos)
    return say_once(fmt::format(
        "session {} has a certificate whose name is not on the list of access.p7s: what it says is dropped",
        line.substr(0, end)));
  if (line.find("unsupported Zenoh protocol version") != std::string_view::npos)
    say_once("a program is refused: it speaks another version of Zenoh's protocol");
}

void LinkNotices::take_not_reached(std::string_view line) {
  const std::string endpoint(line.substr(0, line.find('!')));
  {
    const std::lock_guard lock(mutex_);
    if (ignored_.contains(endpoint)) return;
    if (missing_.size() >= kMostSaid || !missing_.insert(endpoint).second) return;
  }
  const std::size_t begin = std::min(endpoint.size() + 2, line.size());
  tell_(fmt::format("{} is not reached: {}; it is tried again", endpoint,
                    reason_of(line.substr(begin, line.rfind(kEndOfReason) - begin))));
}

void LinkNotices::take_reached(std::string_view line) {
  const std::string endpoint(line);
  {
    const std::lock_guard lock(mutex_);
    if (missing_.erase(endpoint) == 0) return;
  }
  tell_(endpoint + " is reached");
}

void LinkNotices::say_once(const std::string& sentence) {
  {
    const std::lock_guard lock(mutex_);
    if (said_.size() >= kMostSaid || !said_.insert(sentence).second) return;
  }
  tell_(sentence);
}

}  // namespace rds::bus::detail
