// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/rds/secure/certificate_authority.hpp"
#include "tools/rds/secure/roles.hpp"

namespace rds::secure {

struct FolderOptions {
  RobotTopics topics{};
  Validity validity;
  bool force = false;
};

/// From a day before `now`, for machines whose clocks are late, to ten years after.
Validity ten_years(std::chrono::system_clock::time_point now);

/// Makes the folder of a secured domain (common/bus/security.hpp says what is in it) for all roles. The
/// folder and the parts have mode 0700, private keys 0600. It is there whole or not at all.
///
/// @return the names of its parts, or one sentence. A folder that is there is replaced only with `force`, and
///         only if it is one of these.
tl::expected<std::vector<std::string>, std::string> make_secure_folder(const std::filesystem::path& folder,
                                                                       const FolderOptions& options);

}  // namespace rds::secure
