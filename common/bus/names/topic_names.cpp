// SPDX-License-Identifier: Apache-2.0
#include "common/bus/names/topic_names.hpp"

#include <algorithm>
#include <stdexcept>

namespace rds::bus {

bool is_ros_name(std::string_view name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return !name.empty() && is_letter(name.front()) &&
         std::ranges::all_of(name, [&](char c) { return is_letter(c) || is_digit(c); });
}

std::string normal_namespace(const std::string& name) {
  std::string normal;
  std::string_view rest = name;
  if (rest.starts_with('/')) rest.remove_prefix(1);
  while (!rest.empty()) {
    const std::string_view part = rest.substr(0, rest.find('/'));
    if (!is_ros_name(part))
      throw std::invalid_argument("namespace '" + name +
                                  "', expected parts of letters, digits and underscores like /robot1");
    normal.append("/").append(part);
    rest.remove_prefix(std::min(part.size() + 1, rest.size()));
  }
  return normal.empty() ? "/" : normal;
}

TopicNames::TopicNames(const std::string& node_namespace, std::string node_name,
                       std::span<const Remapping> remappings)
    : namespace_(normal_namespace(node_namespace)), node_(std::move(node_name)) {
  for (const auto& [from, to] : remappings) remappings_.emplace_back(expanded(from), expanded(to));
}

std::string TopicNames::full_name(const std::string& topic) const {
  const std::string name = expanded(topic);
  const auto rule = std::ranges::find(remappings_, name, &std::pair<std::string, std::string>::first);
  return rule == remappings_.end() ? name : rule->second;
}

std::string TopicNames::expanded(const std::string& name) const {
  if (name.starts_with('/')) return name.substr(1);
  const std::string above = namespace_ == "/" ? "" : namespace_.substr(1) + "/";
  if (name.starts_with("~/")) return above + node_ + name.substr(1);
  return above + name;
}

}  // namespace rds::bus
