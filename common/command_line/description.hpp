// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace rds::command_line {

/// An option, a flag, or an argument that is known by its place.
struct OptionDescription {
  std::vector<std::string> names;    // --bus, -h; none of an argument by place alone
  std::string place;                 // name of the argument by place; empty if it is none
  std::string value;                 // what kind of value; empty for a flag
  std::vector<std::string> choices;  // all values that are taken; empty: any of that kind
  std::string text;
  std::string default_value;
  std::string environment;  // variable in whose place it stands
  bool required = false;

  [[nodiscard]] bool takes_value() const { return !value.empty(); }
};

struct CommandDescription {
  std::string name;
  std::string text;
  std::vector<OptionDescription> options;
  std::vector<CommandDescription> subcommands;
};

/// What `--help` would say of a program and of all its subcommands; what is hidden there is left out.
CommandDescription describe(const CLI::App& app);

}  // namespace rds::command_line
