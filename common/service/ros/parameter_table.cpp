// SPDX-License-Identifier: Apache-2.0
#include "common/service/ros/parameter_table.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "common/service/ros/setting_comments.hpp"

namespace rds::service {
namespace {

using rcl_interfaces::msg::ParameterValue;
using enum ParameterKind;

/// @throws YAML::Exception if the node is of another kind.
ParameterValue read_as(ParameterKind kind, const YAML::Node& node) {
  ParameterValue value;
  value.type(static_cast<std::uint8_t>(kind));
  switch (kind) {
    case kBool:
      value.bool_value(node.as<bool>());
      break;
    case kInteger:
      value.integer_value(node.as<std::int64_t>());
      break;
    case kDouble:
      value.double_value(node.as<double>());
      break;
    case kString:
      value.string_value(node.as<std::string>());
      break;
    case kBoolArray:
      value.bool_array_value(node.as<std::vector<bool>>());
      break;
    case kIntegerArray:
      value.integer_array_value(node.as<std::vector<std::int64_t>>());
      break;
    case kDoubleArray:
      value.double_array_value(node.as<std::vector<double>>());
      break;
    case kStringArray:
      value.string_array_value(node.as<std::vector<std::string>>());
      break;
    case kByteArray:  // YAML has none
    case kNotSet:
      break;
  }
  return value;
}

/// Of a live setting, which is none of a byte array. Others: null.
YAML::Node to_yaml(const ParameterValue& value) {
  switch (static_cast<ParameterKind>(value.type())) {
    case kBool:
      return YAML::Node(value.bool_value());
    case kInteger:
      return YAML::Node(value.integer_value());
    case kDouble:
      return YAML::Node(value.double_value());
    case kString:
      return YAML::Node(value.string_value());
    case kBoolArray:
      return YAML::Node(value.bool_array_value());
    case kIntegerArray:
      return YAML::Node(value.integer_array_value());
    case kDoubleArray:
      return YAML::Node(value.double_array_value());
    case kStringArray:
      return YAML::Node(value.string_array_value());
    case kByteArray:
    case kNotSet:
      break;
  }
  return {};
}

/// As `ros2 param` names it.
std::string name_of(ParameterKind kind) {
  static constexpr std::array<const char*, 10> kNames{
      "none",       "boolean",       "integer",       "double",       "string",
      "byte array", "boolean array", "integer array", "double array", "string array"};
  const auto index = static_cast<std::size_t>(kind);
  return index < kNames.size() ? kNames[index] : "unknown";
}

template <class T>
bool is_a(const YAML::Node& node) {
  T read;
  return YAML::convert<T>::decode(node, read);
}

/// Of a plain scalar; what stands between quotes is a string.
ParameterKind kind_of_scalar(const YAML::Node& node) {
  if (node.Tag() == "!") return kString;
  if (node.Scalar() == "true" || node.Scalar() == "false") return kBool;
  if (is_a<std::int64_t>(node)) return kInteger;
  return is_a<double>(node) ? kDouble : kString;
}

ParameterKind kind_of(const YAML::Node& node) {
  if (node.IsScalar()) return kind_of_scalar(node);
  if (!node.IsSequence()) return kNotSet;
  const auto all_are = [&](std::initializer_list<ParameterKind> kinds) {
    return node.size() > 0 && std::all_of(node.begin(), node.end(), [&](const YAML::Node& element) {
             return element.IsScalar() && std::ranges::find(kinds, kind_of_scalar(element)) != kinds.end();
           });
  };
  if (all_are({kBool})) return kBoolArray;
  if (all_are({kInteger})) return kIntegerArray;
  return all_are({kInteger, kDouble}) ? kDoubleArray : kStringArray;
}

ParameterValue value_of(const YAML::Node& node, ParameterKind preferred) {
  for (const ParameterKind kind : {preferred, kind_of(node)}) {
    try {
      if (kind != kNotSet) return read_as(kind, node);
    } catch (const YAML::Exception&) {  // of another kind
    }
  }
  ParameterValue text;  // a list of lists, or nothing
  text.type(static_cast<std::uint8_t>(kString));
  text.string_value(node.IsNull() ? "" : YAML::Dump(node));
  return text;
}

/// What a value that was set shall be, too. An empty list says nothing of its elements.
ParameterKind preferred_kind(const YAML::Node& shipped) {
  return shipped.IsSequence() && shipped.size() == 0 ? kNotSet : kind_of(shipped);
}

/// Settings by their names in full.
std::map<std::string, YAML::Node> flattened(const YAML::Node& map, const std::string& above = "") {
  std::map<std::string, YAML::Node> all;
  for (const auto& entry : map) {
    const std::string name = above + entry.first.as<std::string>();
    if (entry.second.IsMap())
      all.merge(flattened(entry.second, name + "."));
    else
      all.emplace(name, entry.second);
  }
  return all;
}

/// Whether a name with so many parts, or fewer, is asked for.
bool is_within(std::string_view name, std::uint64_t depth) {
  return depth == 0 || static_cast<std::uint64_t>(std::ranges::count(name, '.')) < depth;
}

bool is_listed(const std::string& name, const ParameterTable::Names& prefixes, std::uint64_t depth) {
  if (prefixes.empty()) return is_within(name, depth);
  return std::ranges::any_of(prefixes, [&](const std::string& prefix) {
    if (name == prefix) return true;
    return name.starts_with(prefix + ".") &&
           is_within(std::string_view(name).substr(prefix.size() + 1), depth);
  });
}

}  // namespace

ParameterTable::ParameterTable(const std::string& shipped, const YAML::Node& given,
                               const std::vector<std::string>& live) {
  const auto comments = setting_comments(shipped);
  const auto set = flattened(given);
  auto defaults = flattened(YAML::Load(shipped));
  for (const auto& [name, node] : set) defaults.emplace(name, node);
  for (const auto& [name, node] : defaults) {
    Parameter& parameter = parameters_[name];
    const auto found = set.find(name);
    parameter.value = value_of(found == set.end() ? node : found->second, preferred_kind(node));
    if (const auto comment = comments.find(name); comment != comments.end())
      parameter.description = comment->second;
    parameter.is_live = std::ranges::find(live, name) != live.end();
  }
}

rcl_interfaces::msg::ListParametersResult ParameterTable::list(const Names& prefixes,
                                                               std::uint64_t depth) const {
  rcl_interfaces::msg::ListParametersResult result;
  for (const auto& [name, parameter] : parameters_) {
    if (!is_listed(name, prefixes, depth)) continue;
    result.names().push_back(name);
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos) continue;
    const std::string section = name.substr(0, dot);
    if (std::ranges::find(result.prefixes(), section) == result.prefixes().end())
      result.prefixes().push_back(section);
  }
  return result;
}

std::vector<ParameterValue> ParameterTable::values(const Names& names) const {
  std::vector<ParameterValue> values;
  for (const std::string& name : names) {
    const auto found = parameters_.find(name);
    values.push_back(found == parameters_.end() ? ParameterValue() : found->second.value);
  }
  return values;
}

std::vector<std::uint8_t> ParameterTable::kinds(const Names& names) const {
  std::vector<std::uint8_t> kinds;
  for (const ParameterValue& value : values(names)) kinds.push_back(value.type());
  return kinds;
}

std::vector<rcl_interfaces::msg::ParameterDescriptor> ParameterTable::descriptors(const Names& names) const {
  std::vector<rcl_interfaces::msg::ParameterDescriptor> descriptors;
  for (const std::string& name : names) {
    auto& descriptor = descriptors.emplace_back();
    descriptor.name(name);
    const auto found = parameters_.find(name);
    if (found == parameters_.end()) continue;
    descriptor.type(found->second.value.type());
    descriptor.description(found->second.description);
    descriptor.read_only(!found->second.is_live);
  }
  return descriptors;
}

std::string ParameterTable::why_not(const rcl_interfaces::msg::Parameter& wanted) const {
  const std::string& name = wanted.name();
  const auto found = parameters_.find(name);
  if (found == parameters_.end()) return "'" + name + "' is not a setting of this service";
  if (!found->second.is_live)
    return "'" + name + "' is read at the start: start the service again with -p " + name + ":=VALUE";
  const auto kind = static_cast<ParameterKind>(found->second.value.type());
  const auto given = static_cast<ParameterKind>(wanted.value().type());
  if (given == kind || (kind == kDouble && given == kInteger)) return "";
  return "'" + name + "' is of type " + name_of(kind) + ", not " + name_of(given);
}

tl::expected<std::string, std::string> ParameterTable::changes(
    const std::vector<rcl_interfaces::msg::Parameter>& wanted) const {
  YAML::Node values(YAML::NodeType::Map);
  for (const auto& parameter : wanted) {
    if (const std::string reason = why_not(parameter); !reason.empty()) return tl::unexpected(reason);
    values[parameter.name()] = to_yaml(parameter.value());
  }
  return YAML::Dump(values);
}

ParameterValue ParameterTable::set(const std::string& name, const YAML::Node& value) {
  Parameter& parameter = parameters_.at(name);
  return parameter.value = value_of(value, static_cast<ParameterKind>(parameter.value.type()));
}

}  // namespace rds::service
