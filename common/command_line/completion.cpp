// SPDX-License-Identifier: Apache-2.0
#include "common/command_line/completion.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace rds::command_line {
namespace {

/// The name of a shell's function.
std::string function_of(const std::string& command) {
  std::string name = "_" + command;
  std::ranges::replace_if(
      name, [](char c) { return c == ' ' || c == '-'; }, '_');
  return name;
}

/// Visits a command and all below it, each with its whole name: "rds map info".
template <class Visit>
void for_each_command(const std::string& name, const CommandDescription& command, const Visit& visit) {
  visit(name, command);
  for (const CommandDescription& sub : command.subcommands)
    for_each_command(name + " " + sub.name, sub, visit);
}

std::string words_of(const CommandDescription& command) {
  std::vector<std::string> words;
  for (const CommandDescription& sub : command.subcommands) words.push_back(sub.name);
  for (const OptionDescription& option : command.options)
    words.insert(words.end(), option.names.begin(), option.names.end());
  return fmt::format("{}", fmt::join(words, " "));
}

/// A case for each option with a value: its choices, else files.
std::string bash_values(const std::string& name, const CommandDescription& command) {
  std::string cases;
  for (const OptionDescription& option : command.options) {
    if (!option.takes_value() || option.names.empty()) continue;
    std::vector<std::string> patterns;
    for (const std::string& option_name : option.names)
      patterns.push_back(fmt::format("\"{}:{}\"", name, option_name));
    const std::string how =
        option.choices.empty() ? "-f" : fmt::format("-W \"{}\"", fmt::join(option.choices, " "));
    cases +=
        fmt::format("    {})\n      mapfile -t COMPREPLY < <(compgen {} -- \"$current\")\n      return ;;\n",
                    fmt::join(patterns, "|"), how);
  }
  return cases;
}

/// Text between single quotes and, within these, between _arguments' own marks.
std::string zsh_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\'')
      escaped += "'\\''";
    else if (c == '[' || c == ']' || c == ':' || c == '\\')
      (escaped += '\\') += c;
    else
      escaped += c == '\n' ? ' ' : c;
  }
  return escaped;
}

std::string zsh_value(const OptionDescription& option) {
  if (!option.takes_value()) return "";
  if (option.choices.empty()) return fmt::format(":{}:_files", zsh_text(option.value));
  return fmt::format(":{}:({})", zsh_text(option.value), fmt::join(option.choices, " "));
}

std::string zsh_function(const std::string& name, const CommandDescription& command) {
  std::string text = fmt::format("{}() {{\n  local curcontext=$curcontext state line\n  _arguments -C \\\n",
                                 function_of(name));
  for (const OptionDescription& option : command.options)
    for (const std::string& option_name : option.names)
      text += fmt::format("    '{}[{}]{}' \\\n", option_name, zsh_text(option.text), zsh_value(option));
  if (command.subcommands.empty()) return text + "    '*:file:_files'\n}\n\n";
  text += "    '1: :->command' '*:: :->rest'\n  case $state in\n    command)\n      local -a commands=(\n";
  for (const CommandDescription& sub : command.subcommands)
    text += fmt::format("        '{}:{}'\n", sub.name, zsh_text(sub.text));
  text += "      )\n      _describe command commands ;;\n    rest)\n      case $line[1] in\n";
  for (const CommandDescription& sub : command.subcommands)
    text += fmt::format("        {}) {} ;;\n", sub.name, function_of(name + " " + sub.name));
  return text + "      esac ;;\n  esac\n}\n\n";
}

}  // namespace

std::string bash_completion(const CommandDescription& program) {
  std::string known;
  std::string values;
  std::string words;
  for_each_command(program.name, program, [&](const std::string& name, const CommandDescription& command) {
    if (name != program.name) known += fmt::format("{}\"{}\"", known.empty() ? "" : "|", name);
    values += bash_values(name, command);
    words += fmt::format("    \"{}\") words=\"{}\" ;;\n", name, words_of(command));
  });
  const std::string find_command =
      known.empty()
          ? ""
          : fmt::format(
                "  for word in \"${{COMP_WORDS[@]:1:COMP_CWORD-1}}\"; do\n    case \"$command $word\" in\n"
                "      {}) command=\"$command $word\" ;;\n    esac\n  done\n",
                known);
  return fmt::format(
      "# bash completion of {0}\n{1}() {{\n  local current=${{COMP_WORDS[COMP_CWORD]}} command={0} words= "
      "word\n{2}"
      "  case \"$command:${{COMP_WORDS[COMP_CWORD-1]}}\" in\n{3}  esac\n  case \"$command\" in\n{4}  esac\n"
      "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\"; compgen -f -- \"$current\")\n}}\n"
      "complete -o filenames -F {1} {0}\n",
      program.name, function_of(program.name), find_command, values, words);
}

std::string zsh_completion(const CommandDescription& program) {
  std::string text = fmt::format("#compdef {}\n\n", program.name);
  for_each_command(program.name, program, [&](const std::string& name, const CommandDescription& command) {
    text += zsh_function(name, command);
  });
  return text + fmt::format("{} \"$@\"\n", function_of(program.name));
}

}  // namespace rds::command_line
