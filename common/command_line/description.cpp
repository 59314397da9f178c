// SPDX-License-Identifier: Apache-2.0
#include "common/command_line/description.hpp"

#include <CLI/CLI.hpp>

namespace rds::command_line {
namespace {

/// Of CLI11's name of a type with its check: "TEXT:{lz4,zstd}".
std::vector<std::string> choices_in(const std::string& type) {
  const auto open = type.find(":{");
  const auto close = type.find('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  return CLI::detail::split(type.substr(open + 2, close - open - 2), ',');
}

OptionDescription describe(const CLI::Option& option) {
  OptionDescription description;
  for (const std::string& name : option.get_snames()) description.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) description.names.push_back("--" + name);
  if (option.get_positional()) description.place = option.get_name(true);
  const std::string type = option.get_type_name();
  if (option.get_items_expected_max() > 0) {
    description.value = type.substr(0, type.find(':'));
    description.choices = choices_in(type);
  }
  description.text = option.get_description();
  description.default_value = option.get_default_str();
  description.environment = option.get_envname();
  description.required = option.get_required();
  return description;
}

}  // namespace

CommandDescription describe(const CLI::App& app) {
  CommandDescription description{app.get_name(), app.get_description(), {}, {}};
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty()) description.options.push_back(describe(*option));
  const auto is_shown = [](const CLI::App* command) { return !command->get_group().empty(); };
  for (const CLI::App* command : app.get_subcommands(is_shown))
    description.subcommands.push_back(describe(*command));
  return description;
}

}  // namespace rds::command_line
