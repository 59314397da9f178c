// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/replace_folder.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>

namespace rds::map_file {
namespace fs = std::filesystem;
namespace {

/// In three steps: the old one aside, the finished one in place, the old one where the finished one was.
tl::expected<bool, std::string> replace_in_steps(int finished_parent, const fs::path& finished,
                                                 int target_parent, const fs::path& target) {
  fs::path aside = finished;
  aside += ".old";
  if (renameat(target_parent, target.c_str(), finished_parent, aside.c_str()) != 0)
    return tl::unexpected(std::strerror(errno));
  if (renameat(finished_parent, finished.c_str(), target_parent, target.c_str()) != 0) {
    const int reason = errno;
    (void)renameat(finished_parent, aside.c_str(), target_parent, target.c_str());
    return tl::unexpected(std::strerror(reason));
  }
  (void)renameat(finished_parent, aside.c_str(), finished_parent, finished.c_str());
  return true;
}

}  // namespace

tl::expected<bool, std::string> replace_folder(int finished_parent, const fs::path& finished,
                                               int target_parent, const fs::path& target) {
  const auto rename_with = [&](unsigned int flags) {
    return renameat2(finished_parent, finished.c_str(), target_parent, target.c_str(), flags) == 0;
  };
  if (rename_with(RENAME_EXCHANGE)) return true;
  const bool unknown = errno == EINVAL || errno == ENOSYS;
  if (errno != ENOENT && !unknown) return tl::unexpected(std::strerror(errno));
  // An ordinary rename of a folder replaces nothing but an empty folder.
  if (renameat(finished_parent, finished.c_str(), target_parent, target.c_str()) == 0) return false;
  if (!unknown) return tl::unexpected(std::strerror(errno));
  return replace_in_steps(finished_parent, finished, target_parent, target);
}

}  // namespace rds::map_file
