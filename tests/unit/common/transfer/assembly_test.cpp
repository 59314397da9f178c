// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/assembly.hpp"

#include <gtest/gtest.h>

namespace rds::transfer {
namespace {

using Verdict = Assembly::Verdict;

constexpr std::uint64_t kId = 7;

std::vector<std::uint8_t> item_of(std::size_t size) {
  std::vector<std::uint8_t> item(size);
  for (std::size_t i = 0; i < size; ++i) item[i] = static_cast<std::uint8_t>(i * 31 % 251);
  return item;
}

TEST(Assembly, IsWholeInAnyOrder) {
  const auto item = item_of(3 * kChunkBytes + 17);
  Assembly assembly;
  for (std::uint32_t index = 0; index < 4; ++index) assembly.ask(index);
  for (const std::uint32_t index : {3U, 0U, 2U}) {
    EXPECT_EQ(assembly.take(chunk_of(kId, item, index)), Verdict::kTaken);
    EXPECT_FALSE(assembly.complete());
  }
  EXPECT_EQ(assembly.take(chunk_of(kId, item, 2)), Verdict::kRepeated);
  EXPECT_EQ(assembly.take(chunk_of(kId, item, 1)), Verdict::kTaken);
  EXPECT_TRUE(assembly.complete());
  EXPECT_EQ(assembly.bytes(), item);
}

TEST(Assembly, AsksForAFewUntilItKnowsHowManyThereAre) {
  const auto item = item_of(2 * kChunkBytes);
  Assembly assembly;
  for (std::uint32_t index = 0; index < 16; ++index) {
    ASSERT_EQ(assembly.next(), index);
    EXPECT_FALSE(assembly.ask(index));
  }
  EXPECT_EQ(assembly.next(), std::nullopt);
  for (const std::uint32_t lost : {1U, 5U}) assembly.lost(lost);
  EXPECT_EQ(assembly.next(), 1U);
  EXPECT_EQ(assembly.take(chunk_of(kId, item, 0)), Verdict::kTaken);
  EXPECT_TRUE(assembly.ask(1));
  EXPECT_EQ(assembly.next(), std::nullopt) << "there is no chunk 5";
}

TEST(Assembly, RefusesWhatCannotBe) {
  const auto item = item_of(2 * kChunkBytes + 5);
  const auto other = item_of(2 * kChunkBytes + 6);
  Assembly assembly;
  Assembly huge;
  for (std::uint32_t index = 0; index < 3; ++index) assembly.ask(index), huge.ask(index);
  ASSERT_EQ(assembly.take(chunk_of(kId, item, 0)), Verdict::kTaken);
  EXPECT_EQ(assembly.take(chunk_of(kId, other, 1)), Verdict::kImpossible) << "another size";
  Chunk beyond = chunk_of(kId, item, 2);
  beyond.index = 3;
  EXPECT_EQ(assembly.take(beyond), Verdict::kImpossible);
  Chunk torn = chunk_of(kId, item, 2);
  torn.data = torn.data.first(4);
  EXPECT_EQ(assembly.take(torn), Verdict::kImpossible);
  Chunk claims = chunk_of(kId, item, 0);
  claims.item_bytes = static_cast<std::uint32_t>(kMaxItemBytes) + 1;
  EXPECT_EQ(huge.take(claims), Verdict::kImpossible);
  Chunk late = chunk_of(kId, item, 0);
  late.item_bytes = kMaxItemBytes;
  late.index = chunks_in(kMaxItemBytes) - 2;
  EXPECT_EQ(huge.take(late), Verdict::kImpossible) << "far beyond what was asked for";
  EXPECT_TRUE(huge.bytes().empty());
}

}  // namespace
}  // namespace rds::transfer
