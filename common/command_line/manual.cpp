// SPDX-License-Identifier: Apache-2.0
#include "common/command_line/manual.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace rds::command_line {
namespace {

/// Text that roff takes for nothing but text.
std::string plain(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\')
      escaped += "\\e";
    else if (c == '-')
      escaped += "\\-";
    else if (c == '\n')
      escaped += ' ';
    else
      escaped += c;
  }
  return escaped.starts_with('.') || escaped.starts_with('\'') ? "\\&" + escaped : escaped;
}

std::string heading(const OptionDescription& option) {
  std::string line;
  for (const std::string& name : option.names)
    line += (line.empty() ? "" : ", ") + fmt::format("\\fB{}\\fR", plain(name));
  if (!option.place.empty())
    line += (line.empty() ? "" : ", or ") + fmt::format("\\fI{}\\fR", plain(option.place));
  if (option.takes_value() && !option.names.empty()) line += fmt::format(" \\fI{}\\fR", plain(option.value));
  return line;
}

std::string paragraph(const OptionDescription& option) {
  std::string text = plain(option.text);
  const auto add = [&](const std::string& more) { text += (text.empty() ? "" : ". ") + more; };
  if (!option.choices.empty()) add("One of: " + plain(fmt::format("{}", fmt::join(option.choices, ", "))));
  if (!option.default_value.empty()) add("Default: " + plain(option.default_value));
  if (!option.environment.empty()) add(fmt::format("Environment: {}", plain(option.environment)));
  if (option.required) add("Required");
  return fmt::format(".TP\n{}\n{}\n", heading(option), text.empty() ? "\\&" : text);
}

std::string options_of(const CommandDescription& command) {
  std::string text;
  for (const OptionDescription& option : command.options) text += paragraph(option);
  return text;
}

std::string synopsis(const std::string& name, const CommandDescription& command) {
  std::string line = fmt::format("\\fB{}\\fR [\\fIoptions\\fR]", plain(name));
  for (const OptionDescription& option : command.options) {
    if (option.place.empty()) continue;
    const std::string place = fmt::format("\\fI{}\\fR", plain(option.place));
    line += option.required ? " " + place : " [" + place + "]";
  }
  if (!command.subcommands.empty()) line += " \\fIcommand\\fR";
  return line;
}

std::string commands_below(const std::string& name, const CommandDescription& command) {
  std::string text;
  for (const CommandDescription& sub : command.subcommands) {
    const std::string its_name = name + " " + sub.name;
    text += fmt::format(".SS \"{}\"\n{}\n.PP\n{}\n{}", plain(its_name), synopsis(its_name, sub),
                        plain(sub.text), options_of(sub));
    text += commands_below(its_name, sub);
  }
  return text;
}

}  // namespace

std::string manual_page(const CommandDescription& program, const std::string& version) {
  std::string title = program.name;
  std::ranges::transform(title, title.begin(), [](unsigned char c) { return std::toupper(c); });
  std::string page =
      fmt::format(".TH {} 1 \"\" \"RDS\\-SLAM {}\" \"RDS\\-SLAM\"\n", plain(title), plain(version));
  page += fmt::format(".SH NAME\n{} \\- {}\n", plain(program.name), plain(program.text));
  page += fmt::format(".SH SYNOPSIS\n{}\n", synopsis(program.name, program));
  page += ".SH OPTIONS\n" + options_of(program);
  if (!program.subcommands.empty()) page += ".SH COMMANDS\n" + commands_below(program.name, program);
  return page;
}

}  // namespace rds::command_line
