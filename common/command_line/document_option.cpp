// SPDX-License-Identifier: Apache-2.0
#include "common/command_line/document_option.hpp"

#include <CLI/CLI.hpp>

#include "common/command_line/completion.hpp"
#include "common/command_line/manual.hpp"

namespace rds::command_line {
namespace {

std::string document(const CLI::App& program, const std::string& form, const std::string& version) {
  const CommandDescription description = describe(program);
  if (form == "man") return manual_page(description, version);
  return form == "bash" ? bash_completion(description) : zsh_completion(description);
}

}  // namespace

void add_document_option(CLI::App& program, const std::string& version) {
  program
      .add_option_function<std::string>(
          "--document",
          [&program, version](const std::string& form) {
            // As --version: the parser stops, and the program's exit() prints this.
            throw CLI::CallForVersion(document(program, form, version), 0);
          },
          "Write the manual page or a shell's completion")
      ->check(CLI::IsMember({"man", "bash", "zsh"}))
      ->group("");
}

}  // namespace rds::command_line
