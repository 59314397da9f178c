// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "tests/fuzz/mutation.hpp"

namespace rds::fuzz {

/// Good bags of three frames with odometry and an IMU, as files of this ending ("mcap" in all its
/// compressions, "db3"), and one whose pictures are compressed. @param folder  for files on the way.
std::vector<Bytes> bag_seeds(const std::filesystem::path& folder, const std::string& ending);

}  // namespace rds::fuzz
