// SPDX-License-Identifier: Apache-2.0
#include "common/service/ros/ros_arguments.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "common/service/ros/parameters.hpp"

namespace rds::service {
namespace {

using Done = tl::expected<void, std::string>;

constexpr std::string_view kAssign = ":=";
constexpr std::array<std::string_view, 6> kLogSwitches{
    "--enable-rosout-logs",  "--disable-rosout-logs",      "--enable-stdout-logs",
    "--disable-stdout-logs", "--enable-external-lib-logs", "--disable-external-lib-logs"};

/// "name" and "value" of "name:=value".
std::optional<std::pair<std::string, std::string>> assignment(const std::string& text) {
  const std::size_t at = text.find(kAssign);
  if (at == std::string::npos || at == 0) return std::nullopt;
  return std::pair(text.substr(0, at), text.substr(at + kAssign.size()));
}

/// "node" and "name" of "node:name"; without a node it is empty.
std::pair<std::string, std::string> of_node(const std::string& name) {
  const std::size_t at = name.find(':');
  return at == std::string::npos ? std::pair(std::string(), name)
                                 : std::pair(name.substr(0, at), name.substr(at + 1));
}

/// The arguments in their order; what depends on the node's name waits until all are known.
class Reader {
 public:
  explicit Reader(RosArguments& result) : result_(result) {}

  Done take(const std::string& option, const std::string& value) {
    if (option == "--params-file") {
      parameters_.emplace_back(option, value);
      return {};
    }
    if (option == "--log-level") return take_log_level(value);
    if (option == "-e" || option == "--enclave" || option == "--log-config-file" ||
        option == "--log-file-name")
      return {};
    const auto pair = assignment(value);
    const bool is_parameter = option == "-p" || option == "--param";
    if (!pair || pair->second.empty())
      return tl::unexpected(
          fmt::format("{} {}: expected {}", option, value, is_parameter ? "name:=value" : "from:=to"));
    if (!is_parameter) return take_rule(*pair);
    parameters_.emplace_back(option, value);
    return {};
  }

  /// What is for this node alone, now that its name is known.
  Done settle(const std::string& node_name, const std::string& node_namespace) {
    const std::string node = result_.node_name.value_or(node_name);
    const std::string full = result_.node_namespace.value_or(node_namespace) + "/" + node;
    for (const auto& [only, rule] : rules_)
      if (only.empty() || only == node_name || only == node) result_.remappings.push_back(rule);
    for (const auto& [option, value] : parameters_) {
      if (option == "--params-file") {
        if (auto read = read_parameter_file(value, full, result_.parameters); !read) return read;
        continue;
      }
      const auto [qualified, text] = *assignment(value);
      const auto [only, name] = of_node(qualified);
      if (!only.empty() && only != node) continue;
      try {
        set_parameter(name, YAML::Load(text), result_.parameters);
      } catch (const YAML::Exception& e) {
        return tl::unexpected(fmt::format("{} {}: {}", option, value, e.msg));
      }
    }
    return {};
  }

 private:
  Done take_rule(const std::pair<std::string, std::string>& rule) {
    const auto [only, from] = of_node(rule.first);
    if (from == "__node" || from == "__name") {
      if (!bus::is_ros_name(rule.second))
        return tl::unexpected(
            fmt::format("node name '{}', expected letters, digits and underscores", rule.second));
      result_.node_name = rule.second;
    } else if (from == "__ns") {
      result_.node_namespace = rule.second;
    } else {
      rules_.push_back({only, {from, rule.second}});
    }
    return {};
  }

  Done take_log_level(const std::string& value) {
    static const std::map<std::string, std::string> kLevels{
        {"debug", "debug"}, {"info", "info"}, {"warn", "warning"}, {"error", "error"}, {"fatal", "error"}};
    const auto pair = assignment(value);  // of one logger
    std::string level = pair ? pair->second : value;
    std::ranges::transform(level, level.begin(), [](char c) {
      return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    const auto known = kLevels.find(level);
    if (known == kLevels.end())
      return tl::unexpected(fmt::format("--log-level {}: expected debug, info, warn, error or fatal", value));
    result_.log_level = known->second;
    return {};
  }

  RosArguments& result_;
  std::vector<std::pair<std::string, bus::Remapping>> rules_;    // of which node
  std::vector<std::pair<std::string, std::string>> parameters_;  // option and value
};

bool takes_value(const std::string& option) {
  static constexpr std::array<std::string_view, 10> kOptions{
      "-r",          "--remap", "-p",        "--param",           "--params-file",
      "--log-level", "-e",      "--enclave", "--log-config-file", "--log-file-name"};
  return std::ranges::find(kOptions, option) != kOptions.end();
}

}  // namespace

CommandLine split_command_line(const std::vector<std::string>& arguments) {
  CommandLine line;
  bool inside = false;
  for (const std::string& argument : arguments) {
    if (argument == "--ros-args")
      inside = true;
    else if (inside && argument == "--")
      inside = false;
    else
      (inside ? line.ros : line.own).push_back(argument);
  }
  return line;
}

tl::expected<RosArguments, std::string> read_ros_arguments(const std::vector<std::string>& arguments,
                                                           const std::string& node_name,
                                                           const std::string& node_namespace) {
  RosArguments result;
  result.parameters = YAML::Node(YAML::NodeType::Map);
  Reader reader(result);
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (takes_value(argument)) {
      if (i + 1 == arguments.size()) return tl::unexpected(argument + ": expected a value behind it");
      if (auto taken = reader.take(argument, arguments[++i]); !taken) return tl::unexpected(taken.error());
    } else if (std::ranges::find(kLogSwitches, argument) == kLogSwitches.end()) {
      return tl::unexpected(argument +
                            ": not an argument of ROS, expected -r, -p, --params-file or --log-level");
    }
  }
  if (auto settled = reader.settle(node_name, node_namespace); !settled)
    return tl::unexpected(settled.error());
  return result;
}

}  // namespace rds::service
