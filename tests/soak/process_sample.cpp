// SPDX-License-Identifier: Apache-2.0
#include "tests/soak/process_sample.hpp"

#include <fstream>
#include <string>

#include <sys/stat.h>

namespace rds::test {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kBlock = 512;  // bytes, of st_blocks

std::uint64_t blocks_of(const fs::path& file) {
  struct stat status {};
  return stat(file.c_str(), &status) == 0 && S_ISREG(status.st_mode)
             ? static_cast<std::uint64_t>(status.st_blocks) * kBlock
             : 0;
}

}  // namespace

std::uint64_t memory_of(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/smaps_rollup");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("Pss:")) return std::stoull(line.substr(4)) * 1024;
  return 0;
}

std::uint64_t nameless_files_of(pid_t process) {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/proc/" + std::to_string(process) + "/fd", error)) {
    const std::string target = fs::read_symlink(entry.path(), error).string();
    if (target.ends_with(" (deleted)") && !target.starts_with("/dev/shm")) bytes += blocks_of(entry.path());
  }
  return bytes;
}

std::uint64_t disk_of(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(folder, error)) bytes += blocks_of(entry.path());
  return bytes;
}

}  // namespace rds::test
