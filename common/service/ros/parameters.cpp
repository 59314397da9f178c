// SPDX-License-Identifier: Apache-2.0
#include "common/service/ros/parameters.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace rds::service {
namespace {

constexpr const char* kParameters = "ros__parameters";
constexpr std::array<std::string_view, 3> kOfEveryNode{"use_sim_time", "start_type_description_service",
                                                       "qos_overrides"};

std::vector<std::string> parts_of(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::string part;
  for (const char c : text + separator) {
    if (c != separator) {
      part += c;
    } else if (!part.empty()) {
      parts.push_back(std::exchange(part, {}));
    }
  }
  return parts;
}

bool fits(std::span<const std::string> pattern, std::span<const std::string> name) {
  if (pattern.empty()) return name.empty();
  if (pattern.front() == "**") {
    for (std::size_t skipped = 0; skipped <= name.size(); ++skipped)
      if (fits(pattern.subspan(1), name.subspan(skipped))) return true;
    return false;
  }
  if (name.empty() || (pattern.front() != "*" && pattern.front() != name.front())) return false;
  return fits(pattern.subspan(1), name.subspan(1));
}

/// @param name  of the section that `values` are in, with a dot at its end.
void set_all(const YAML::Node& values, const std::string& name, YAML::Node& settings) {
  for (const auto& entry : values) {
    const std::string inner = name + entry.first.as<std::string>();
    if (entry.second.IsMap())
      set_all(entry.second, inner + ".", settings);
    else
      set_parameter(inner, entry.second, settings);
  }
}

/// @param above  the names that lead here.
void take(const YAML::Node& names, const std::string& above, const std::string& node, YAML::Node& settings) {
  for (const auto& entry : names) {
    const auto name = entry.first.as<std::string>();
    if (!entry.second.IsMap()) continue;
    if (name != kParameters)
      take(entry.second, above + "/" + name, node, settings);
    else if (is_meant(above, node))
      set_all(entry.second, "", settings);
  }
}

}  // namespace

void set_parameter(const std::string& name, const YAML::Node& value, YAML::Node& settings) {
  std::vector<std::string> parts = parts_of(name, '.');
  if (parts.empty() || std::ranges::find(kOfEveryNode, parts.front()) != kOfEveryNode.end()) return;
  YAML::Node section = settings;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    if (!section[parts[i]].IsDefined() || !section[parts[i]].IsMap())
      section[parts[i]] = YAML::Node(YAML::NodeType::Map);
    section.reset(section[parts[i]]);
  }
  section[parts.back()] = value;
}

bool is_meant(const std::string& pattern, const std::string& node) {
  return fits(parts_of(pattern, '/'), parts_of(node, '/'));
}

tl::expected<void, std::string> read_parameter_file(const std::string& file, const std::string& node,
                                                    YAML::Node& settings) {
  try {
    const YAML::Node names = YAML::LoadFile(file);
    if (!names.IsMap())
      return tl::unexpected(fmt::format("{}: expected names of nodes with {}", file, kParameters));
    take(names, "", node, settings);
    return {};
  } catch (const YAML::BadFile&) {
    return tl::unexpected(fmt::format("{}: cannot be read", file));
  } catch (const YAML::Exception& e) {
    return tl::unexpected(fmt::format("{}:{}: not a parameter file: {}", file, e.mark.line + 1, e.msg));
  }
}

}  // namespace rds::service
