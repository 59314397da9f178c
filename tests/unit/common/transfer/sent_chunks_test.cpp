// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/sent_chunks.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace rds::transfer {
namespace {

constexpr Stream kStream = Stream::kKeyframeImages;

/// Of an item of 200 chunks.
Chunk chunk(std::uint64_t number, std::uint32_t index) {
  return {number, 200 * kChunkBytes, index, {}};
}

TEST(SentChunks, KnowsWhatWasSentBefore) {
  SentChunks sent;
  EXPECT_FALSE(sent.note(1, kStream, chunk(7, 100)));
  EXPECT_FALSE(sent.note(1, kStream, chunk(7, 0)));
  EXPECT_TRUE(sent.note(1, kStream, chunk(7, 100)));
  EXPECT_TRUE(sent.note(1, kStream, chunk(7, 0)));
  EXPECT_FALSE(sent.note(1, kStream, chunk(7, 50)));
}

TEST(SentChunks, TellsReadersStreamsAndItemsApart) {
  SentChunks sent;
  EXPECT_FALSE(sent.note(1, kStream, chunk(7, 3)));
  EXPECT_FALSE(sent.note(2, kStream, chunk(7, 3)));
  EXPECT_FALSE(sent.note(1, Stream::kKeyframeFeatures, chunk(7, 3)));
  EXPECT_FALSE(sent.note(1, kStream, chunk(8, 3)));
}

TEST(SentChunks, RemembersAFewItemsOnly) {
  SentChunks sent;
  EXPECT_FALSE(sent.note(1, kStream, chunk(0, 0)));
  for (std::uint64_t number = 1; number < SentChunks::kItems; ++number)
    sent.note(1, kStream, chunk(number, 0));
  EXPECT_TRUE(sent.note(1, kStream, chunk(0, 0)));
  sent.note(1, kStream, chunk(SentChunks::kItems, 0));
  EXPECT_FALSE(sent.note(1, kStream, chunk(0, 0)));
}

TEST(SentChunks, KeepsNothingOfWhatIsNotThere) {
  SentChunks sent;
  constexpr auto kFar = std::numeric_limits<std::uint32_t>::max();
  for (const std::uint32_t why : {kAbsent, kLost, kAbsent, kLost})
    EXPECT_FALSE(sent.note(1, kStream, {7, why, kFar, {}}));
}

}  // namespace
}  // namespace rds::transfer
