// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/board/page_client.hpp"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

#include "common/map_file/named_map.hpp"

namespace rds::viewer {
namespace {

using nlohmann::json;
constexpr std::array<const char*, 4> kVerbs{"pause", "resume", "reset", "save"};

Bytes refusal(const std::string& verb, const std::string& reason) {
  return text_frame(
      Kind::kReply,
      json{{"verb", verb}, {"service", "rds-viewer"}, {"success", false}, {"message", reason}}.dump(
          -1, ' ', false, json::error_handler_t::replace));
}

}  // namespace

bool PageClient::receive(std::string_view message, bool binary) {
  if (binary) return false;
  const json said = json::parse(message, nullptr, false);
  if (!said.is_object()) return false;
  if (const auto picture = said.find("picture"); picture != said.end()) {
    if (!picture->is_boolean()) return false;
    cursor_.wants_picture = picture->get<bool>();
    return true;
  }
  const auto verb = said.find("command");
  if (verb == said.end() || !verb->is_string()) return false;
  const auto argument = said.find("argument");
  if (argument != said.end() && !argument->is_string()) return false;
  return command(verb->get<std::string>(), argument == said.end() ? "" : argument->get<std::string>());
}

bool PageClient::command(const std::string& verb, const std::string& argument) {
  if (std::ranges::find(kVerbs, verb) == kVerbs.end()) return false;
  if (!send_)
    reply(refusal(verb, "commands are not allowed here (setting allow_commands)"));
  else if (const auto named = map_file::check_map_name(argument); verb == "save" && !named)
    reply(refusal(verb, named.error()));
  else
    send_({verb, argument});
  return true;
}

void PageClient::reply(Bytes frame) {
  replies_.push_back(std::make_shared<const Bytes>(std::move(frame)));
  if (replies_.size() > kMostReplies) replies_.pop_front();
}

std::optional<Outgoing> PageClient::next() {
  if (!replies_.empty()) {
    Outgoing first{std::move(replies_.front())};
    replies_.pop_front();
    return first;
  }
  SharedBytes frame = board_.next(cursor_);
  return frame ? std::optional(Outgoing{std::move(frame)}) : std::nullopt;
}

}  // namespace rds::viewer
