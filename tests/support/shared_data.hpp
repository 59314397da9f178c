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
/// unless the test was declared RECORDINGS and the fixture could make it.
std::filesystem::path dynamic_sequence(const std::string& name);

/// Folder of a recording that a fixture has rendered: `room` and `room_empty` (its twin without people) for a
/// test declared RECORDINGS; `rpy`, `halfsphere`, `static`, with people, `loop` and `floor` for one declared
/// PATHS.
/// @throws std::runtime_error if it is not there.
std::filesystem::path rendered_recording(const std::string& name);

/// A recording to test on: of a real camera, or rendered where there is none.
struct TestRecording {
  std::filesystem::path folder;
  std::size_t frames;
  bool rendered;

  /// The bound for this one; a rendered one has exact truth.
  [[nodiscard]] double bound(double recorded_one, double rendered_one) const {
    return rendered ? rendered_one : recorded_one;
  }
};

/// A camera moves, nothing else: RDS_SHARED's 7scenes_kitchen, else `room_empty`.
TestRecording recording_of_a_room();
/// The same with people: kitchen_walkers, else `room`.
TestRecording recording_with_people();

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
