// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace rds::test {

/// 4 s of a recording, to and fro for 30 s: what a camera misses in 5 s it has seen, and sees again.
/// @param name  "rpy" (tum_fr1_rpy, nobody walks) or "walkers" (kitchen_walkers); rendered rooms where
/// RDS_SHARED is not set. @param place  where its lists and links are made. @return its folder
/// @throws std::runtime_error
std::filesystem::path to_and_fro(const std::string& name, const std::filesystem::path& place);

}  // namespace rds::test
