// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/network_script.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "services/detector/core/detection.hpp"

namespace rds::tools {
namespace fs = std::filesystem;
namespace {

using detector::DetectorError;

fs::path find_script(const std::string& name) {
  std::vector<fs::path> folders;
  if (const char* named = std::getenv("RDS_NETWORK_SCRIPTS"); named != nullptr) folders.emplace_back(named);
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  folders.push_back(program.parent_path().parent_path() / "share" / "rds-slam" / "networks");
  folders.emplace_back(RDS_NETWORK_SCRIPTS_SOURCE);
  for (const fs::path& folder : folders)
    if (fs::is_regular_file(folder / name, ignored)) return folder / name;
  throw DetectorError(fmt::format("{}: not found; name its folder in RDS_NETWORK_SCRIPTS", name));
}

}  // namespace

void run_network_script(const std::string& name, const fs::path& folder) {
  std::string script = find_script(name).string();
  std::string argument = folder.string();
  std::vector<char*> arguments{script.data(), argument.data(), nullptr};
  pid_t child = 0;
  if (const int error = posix_spawn(&child, script.c_str(), nullptr, nullptr, arguments.data(), environ);
      error != 0)
    throw DetectorError(fmt::format("{}: cannot be run: {}", script, std::strerror(error)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw DetectorError(fmt::format("{}: failed, see its message above", script));
}

}  // namespace rds::tools
