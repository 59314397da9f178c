// SPDX-License-Identifier: Apache-2.0
#include "common/store/scratch_memory.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <memory_resource>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace rds::store {
namespace {

using Picture = std::pmr::vector<std::uint8_t>;

constexpr std::size_t kPicture = 300'000;

/// Of this process, of what lies in files [bytes].
std::size_t resident_of_files() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("RssFile:")) return std::stoul(line.substr(8)) * 1024;
  return 0;
}

Picture picture(ScratchMemory& memory, std::size_t number) {
  return {kPicture, static_cast<std::uint8_t>(number + 1), &memory};
}

std::vector<Picture> pictures(ScratchMemory& memory, std::size_t count) {
  std::vector<Picture> made;
  made.reserve(count);
  for (std::size_t i = 0; i < count; ++i) made.push_back(picture(memory, i));
  return made;
}

TEST(ScratchMemory, WhatRestsIsNotInRamAndComesBack) {
  ScratchMemory memory;
  const auto kept = pictures(memory, 200);
  EXPECT_EQ(memory.bytes_in_ram(), 0U);
  const std::size_t before = resident_of_files();
  memory.rest();
  EXPECT_LT(resident_of_files() + 190 * kPicture, before);
  for (std::size_t i = 0; i < kept.size(); ++i)
    EXPECT_EQ(std::ranges::count(kept[i], static_cast<std::uint8_t>(i + 1)), kPicture) << i;
}

TEST(ScratchMemory, UsesAgainWhatIsGivenBack) {
  ScratchMemory memory;
  std::set<const std::uint8_t*> places;
  for (std::size_t i = 0; i < 1000; ++i) places.insert(picture(memory, i).data());
  EXPECT_EQ(places.size(), 1U);
  const auto kept = pictures(memory, 100);
  EXPECT_LT(memory.bytes_in_file(), 100 * kPicture * 3 / 2);
}

TEST(ScratchMemory, LiesInTheFileAtAnyAlignment) {
  ScratchMemory memory;
  std::pmr::unsynchronized_pool_resource pool(
      {.max_blocks_per_chunk = 64, .largest_required_pool_block = 1U << 16U}, &memory);
  for (std::size_t size = 8; size <= std::size_t{1} << 18U; size *= 2) {
    const std::pmr::vector<std::uint8_t> piece(size, 1, &pool);
    void* const aligned = memory.allocate(size, size);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(aligned) % size, 0U);
    memory.deallocate(aligned, size, size);
  }
  EXPECT_EQ(memory.bytes_in_ram(), 0U);
}

TEST(ScratchMemory, IsOrdinaryMemoryWhereThereIsNoRoom) {
  ScratchMemory nowhere("/nonexistent");
  {
    const Picture kept = picture(nowhere, 6);
    EXPECT_EQ(kept.back(), 7);
    EXPECT_EQ(nowhere.bytes_in_ram(), kPicture);
    EXPECT_EQ(nowhere.bytes_in_file(), 0U);
  }
  EXPECT_EQ(nowhere.bytes_in_ram(), 0U);
}

}  // namespace
}  // namespace rds::store
