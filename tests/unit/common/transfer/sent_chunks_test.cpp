// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/sent_chunks.hpp"

#include <gtest/gtest.h>

namespace rds::transfer {
namespace {

constexpr Stream kStream = Stream::kKeyframeImages;

TEST(SentChunks, KnowsWhatWasSentBefore) {
  SentChunks sent;
  EXPECT_FALSE(sent.note(1, kStream, 7, 100));
  EXPECT_FALSE(sent.note(1, kStream, 7, 0));
  EXPECT_TRUE(sent.note(1, kStream, 7, 100));
  EXPECT_TRUE(sent.note(1, kStream, 7, 0));
  EXPECT_FALSE(sent.note(1, kStream, 7, 50));
}

TEST(SentChunks, TellsReadersStreamsAndItemsApart) {
  SentChunks sent;
  EXPECT_FALSE(sent.note(1, kStream, 7, 3));
  EXPECT_FALSE(sent.note(2, kStream, 7, 3));
  EXPECT_FALSE(sent.note(1, Stream::kKeyframeFeatures, 7, 3));
  EXPECT_FALSE(sent.note(1, kStream, 8, 3));
}

TEST(SentChunks, RemembersAFewItemsOnly) {
  SentChunks sent;
  EXPECT_FALSE(sent.note(1, kStream, 0, 0));
  for (std::uint64_t number = 1; number < SentChunks::kItems; ++number) sent.note(1, kStream, number, 0);
  EXPECT_TRUE(sent.note(1, kStream, 0, 0));
  sent.note(1, kStream, SentChunks::kItems, 0);
  EXPECT_FALSE(sent.note(1, kStream, 0, 0));
}

}  // namespace
}  // namespace rds::transfer
