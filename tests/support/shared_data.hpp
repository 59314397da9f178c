// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace rds::test {

/// Folder of recordings and models that the environment variable RDS_SHARED names; empty if unset.
std::filesystem::path shared();

/// Why `shared() / name` cannot be used, naming what is missing; empty if it can.
std::string why_not_shared(const std::string& name);

/// Folder of a recording into which people were put (kitchen_walkers, kitchen_crowd, fr1_walkers); empty
/// unless the test was declared DYNAMIC and the fixture could make it.
std::filesystem::path dynamic_sequence(const std::string& name);

}  // namespace rds::test

/// Skips the test, with the reason, unless RDS_SHARED is set and holds `name` ("" for the folder itself).
#define RDS_REQUIRE_SHARED(name)                                                       \
  do {                                                                                 \
    if (const std::string reason = ::rds::test::why_not_shared(name); !reason.empty()) \
      GTEST_SKIP() << reason;                                                          \
  } while (false)

/// Skips the test, with the reason, unless the dynamic sequence is there.
#define RDS_REQUIRE_DYNAMIC(name)                                                 \
  do {                                                                            \
    if (::rds::test::dynamic_sequence(name).empty())                              \
      GTEST_SKIP() << "RDS_SHARED is not set, so sequence " name " was not made"; \
  } while (false)
