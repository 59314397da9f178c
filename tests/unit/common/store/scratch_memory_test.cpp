// SPDX-License-Identifier: Apache-2.0
#include "common/store/scratch_memory.hpp"

#include <algorithm>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace rds::store {
namespace {

constexpr std::size_t kPicture = 300'000;

/// Of this process, of what lies in files [bytes].
std::size_t resident_of_files() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("RssFile:")) return std::stoul(line.substr(8)) * 1024;
  return 0;
}

std::vector<std::shared_ptr<std::uint8_t[]>> pictures(ScratchMemory& memory, std::size_t count) {
  std::vector<std::shared_ptr<std::uint8_t[]>> made;
  for (std::size_t i = 0; i < count; ++i) {
    made.push_back(memory.allocate(kPicture));
    std::fill_n(made.back().get(), kPicture, static_cast<std::uint8_t>(i + 1));
  }
  return made;
}

TEST(ScratchMemory, WhatRestsIsNotInRamAndComesBack) {
  ScratchMemory memory;
  const auto kept = pictures(memory, 200);
  const std::size_t before = resident_of_files();
  memory.rest();
  EXPECT_LT(resident_of_files() + 190 * kPicture, before);
  for (std::size_t i = 0; i < kept.size(); ++i)
    EXPECT_EQ(std::count(kept[i].get(), kept[i].get() + kPicture, static_cast<std::uint8_t>(i + 1)), kPicture)
        << i;
}

TEST(ScratchMemory, UsesAgainWhatIsGivenBack) {
  ScratchMemory memory;
  std::set<const std::uint8_t*> places;
  for (int i = 0; i < 1000; ++i) places.insert(memory.allocate(kPicture).get());
  EXPECT_EQ(places.size(), 1U);
  const auto kept = pictures(memory, 100);
  EXPECT_LT(memory.bytes(), 100 * kPicture * 3 / 2);
}

TEST(ScratchMemory, OutlastsTheObjectThatGaveIt) {
  std::shared_ptr<std::uint8_t[]> kept;
  {
    ScratchMemory memory;
    kept = memory.allocate(kPicture);
  }
  std::fill_n(kept.get(), kPicture, std::uint8_t{7});
  EXPECT_EQ(kept[kPicture - 1], 7);
}

TEST(ScratchMemory, GivesNothingWhereThereIsNoRoom) {
  ScratchMemory nowhere("/nonexistent");
  EXPECT_EQ(nowhere.allocate(kPicture), nullptr);
  ScratchMemory memory;
  EXPECT_EQ(memory.allocate(std::size_t{1} << 50U), nullptr);
  EXPECT_NE(memory.allocate(kPicture), nullptr);
}

}  // namespace
}  // namespace rds::store
