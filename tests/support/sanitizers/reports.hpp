// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/process.hpp"

namespace rds::test {

/// A folder into which sanitized processes write what they find.
class SanitizerReports {
 public:
  /// For these processes: the sanitizers' options as they are, and the folder.
  [[nodiscard]] Process::Environment environment() const {
    Process::Environment environment;
    for (const char* name : {"ASAN_OPTIONS", "LSAN_OPTIONS", "TSAN_OPTIONS", "UBSAN_OPTIONS"}) {
      const char* options = std::getenv(name);
      environment[name] = (options == nullptr ? "" : std::string(options) + ":") + "log_path='" +
                          (folder_ / "report").string() + "'";
    }
    environment["ASAN_OPTIONS"] += ":verify_asan_link_order=0";  // a preloaded library comes first
    return environment;
  }
  /// What they have found, a text each.
  [[nodiscard]] std::vector<std::string> found() const {
    std::vector<std::string> texts;
    for (const auto& report : std::filesystem::directory_iterator(folder_.path()))
      texts.push_back(read_text(report.path()));
    return texts;
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace rds::test
