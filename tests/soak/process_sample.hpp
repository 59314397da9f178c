// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include <sys/types.h>

namespace rds::test {

/// Memory of a process that no other one shares, and what it has on file mappings: proportional set size
/// [bytes].
std::uint64_t memory_of(pid_t process);

/// What the files take on the disk that a process has open without a name [bytes].
std::uint64_t nameless_files_of(pid_t process);

/// What the files below a folder take on the disk [bytes].
std::uint64_t disk_of(const std::filesystem::path& folder);

}  // namespace rds::test
