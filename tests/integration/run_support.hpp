// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/process.hpp"

namespace rds::test {

/// The `rds` executable that was built with the tests.
std::string rds();

/// `rds run` on a dataset with these further arguments and environment variables. @return exit status,
/// stdout, stderr.
ProcessResult run(const std::filesystem::path& dataset, const std::filesystem::path& out,
                  const std::vector<std::string>& arguments,
                  std::chrono::seconds limit = std::chrono::seconds(300),
                  const Process::Environment& environment = {});

/// Figures of `rds eval DATASET OUT --json [--background DIR] [ARGUMENTS]`.
nlohmann::json score(const std::filesystem::path& dataset, const std::filesystem::path& out,
                     const std::filesystem::path& background = {},
                     const std::vector<std::string>& arguments = {});

/// A number of a command's answer, which is JSON; 0 if there is none.
std::uint64_t number_in(const std::string& answer, const char* key);

/// Process ids of the children of `parent` whose executable is called `name`.
std::vector<pid_t> children(pid_t parent, const std::string& name);

}  // namespace rds::test
