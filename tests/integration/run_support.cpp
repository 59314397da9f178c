// SPDX-License-Identifier: Apache-2.0
#include "tests/integration/run_support.hpp"

#include <fstream>
#include <stdexcept>

namespace rds::test {
namespace fs = std::filesystem;

std::string rds() {
  return RDS_BIN_DIR "/rds";
}

ProcessResult run(const fs::path& dataset, const fs::path& out, const std::vector<std::string>& arguments,
                  std::chrono::seconds limit, const Process::Environment& environment) {
  std::vector<std::string> command{rds(), "run", "--dataset", dataset.string(), "--out", out.string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run_process(command, limit, environment);
}

nlohmann::json score(const fs::path& dataset, const fs::path& out, const fs::path& background,
                     const std::vector<std::string>& arguments) {
  std::vector<std::string> command{rds(), "eval", dataset.string(), out.string(), "--json"};
  if (!background.empty()) command.insert(command.end(), {"--background", background.string()});
  command.insert(command.end(), arguments.begin(), arguments.end());
  const ProcessResult result = run_process(command, std::chrono::seconds(120));
  if (result.status != 0) throw std::runtime_error("rds eval: " + result.standard_error);
  return nlohmann::json::parse(result.standard_output);
}

std::uint64_t number_in(const std::string& answer, const char* key) {
  const auto json = nlohmann::json::parse(answer, nullptr, false);
  return json.is_object() ? json.value(key, std::uint64_t{0}) : 0;
}

std::vector<pid_t> children(pid_t parent, const std::string& name) {
  std::vector<pid_t> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::error_code error;
    const fs::path executable = fs::read_symlink(entry.path() / "exe", error);
    if (error || executable.filename() != name) continue;
    std::ifstream status(entry.path() / "status");
    for (std::string line; std::getline(status, line);)
      if (line == "PPid:\t" + std::to_string(parent))
        found.push_back(std::stoi(entry.path().filename().string()));
  }
  return found;
}

}  // namespace rds::test
