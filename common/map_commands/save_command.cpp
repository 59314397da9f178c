// SPDX-License-Identifier: Apache-2.0
#include "common/map_commands/save_command.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/messages/json.hpp"

namespace rds::map_commands {
namespace {

using map_file::SaveOrder;

SaveOrder of_name(const service::PendingCommand& command, const std::string& own_part) {
  SaveOrder order{command.argument, fmt::format("{:016x}", command.request_id), {own_part}};
  if (command.to_all) order.parts.assign(map_file::kParts.begin(), map_file::kParts.end());
  return order;
}

tl::expected<SaveOrder, std::string> of_json(const std::string& text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  SaveOrder order;
  try {
    order.name = json.at("name").get<std::string>();
    order.id = json.at("id").get<std::string>();
    order.parts = json.at("parts").get<std::vector<std::string>>();
  } catch (const nlohmann::json::exception&) {
    return tl::unexpected<std::string>(
        R"(not a save, expected the name of a map, or {"name": NAME, "id": ID, "parts": [PART, ...]})");
  }
  return order;
}

}  // namespace

tl::expected<SaveOrder, std::string> parse_save(const service::PendingCommand& command,
                                                const std::string& own_part) {
  auto order = command.argument.starts_with('{') ? of_json(command.argument) : of_name(command, own_part);
  if (!order) return order;
  if (const auto checked = check(*order); !checked) return tl::unexpected(checked.error());
  if (std::ranges::count(order->parts, own_part) == 0)
    return tl::unexpected(fmt::format("'{}' is none of the parts that are to be saved", own_part));
  return order;
}

std::string save_answer(const SaveOrder& order, map_file::SaveState state, const std::filesystem::path& maps,
                        const std::string& what) {
  using map_file::SaveState;
  const char* name = state == SaveState::kWaits       ? "waits"
                     : state == SaveState::kPublished ? "published"
                                                      : "complete";
  return messages::to_text(nlohmann::ordered_json{{"map", order.name},
                                                  {"id", order.id},
                                                  {"state", name},
                                                  {"folder", (maps / order.name).string()},
                                                  {"saved", what}});
}

}  // namespace rds::map_commands
