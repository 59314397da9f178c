// SPDX-License-Identifier: Apache-2.0
#include "tests/support/shared_data.hpp"

#include <cstdlib>

namespace rds::test {

std::filesystem::path shared() {
  const char* folder = std::getenv("RDS_SHARED");
  return folder == nullptr ? "" : folder;
}

std::string why_not_shared(const std::string& name) {
  if (shared().empty()) return "RDS_SHARED is not set, so there is no recording " + name;
  if (!std::filesystem::exists(shared() / name)) return (shared() / name).string() + " is missing";
  return "";
}

std::filesystem::path dynamic_sequence(const std::string& name) {
  const char* folder = std::getenv("RDS_DYNAMIC");
  if (folder == nullptr || !std::filesystem::exists(std::filesystem::path(folder) / name / "made")) return "";
  return std::filesystem::path(folder) / name;
}

}  // namespace rds::test
