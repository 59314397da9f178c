// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/receiver.hpp"

#include <gtest/gtest.h>

namespace rds::transfer {
namespace {

using namespace std::chrono_literals;

constexpr Stream kImages = Stream::kKeyframeImages;
constexpr Stream kFeatures = Stream::kKeyframeFeatures;
constexpr Stream kMap = Stream::kMap;

/// Answers everything at once.
std::vector<ItemId> fetch_all(Receiver& receiver, std::size_t bytes, Time now = 1s) {
  const std::vector<std::uint8_t> item(bytes, 1);
  std::vector<ItemId> whole;
  for (auto requests = receiver.due(now); !requests.empty(); requests = receiver.due(now)) {
    now += 1ms;
    for (const Request& request : requests)
      for (std::uint32_t i = request.first; i < std::min(request.first + request.count, chunks_in(bytes));
           ++i)
        if (const auto taken = receiver.take(chunk_of(request.item, item, i), now))
          whole.push_back(taken->id);
  }
  return whole;
}

TEST(Receiver, FetchesTheNewestOfEachStreamFirst) {
  Receiver receiver;
  receiver.want(kImages, false);
  receiver.want(kFeatures, false);
  receiver.offer({kImages, 3, 5});
  receiver.offer({kFeatures, 4, 5});
  EXPECT_EQ(fetch_all(receiver, 100'000),
            (std::vector<ItemId>{{kImages, 5}, {kFeatures, 5}, {kImages, 4}, {kFeatures, 4}, {kImages, 3}}));
  EXPECT_EQ(receiver.lacking(kImages), 0U);
  EXPECT_EQ(receiver.next_due(), std::nullopt);
}

TEST(Receiver, AsksForNothingThatItHasOrDoesNotWant) {
  Receiver receiver;
  receiver.want(kImages, false);
  receiver.offer({kImages, 0, 2});
  receiver.offer({kFeatures, 0, 9});
  receiver.have({kImages, 1});
  EXPECT_EQ(fetch_all(receiver, 10), (std::vector<ItemId>{{kImages, 2}, {kImages, 0}}));
  receiver.offer({kImages, 0, 2});
  EXPECT_TRUE(receiver.due(9s).empty()) << "the same offer again";
}

TEST(Receiver, FinishesAMapBeforeItFetchesTheNewest) {
  Receiver receiver;
  receiver.want(kMap, true);
  receiver.offer({kMap, 1, 1});
  const std::vector<std::uint8_t> map(100 * kChunkBytes, 1);
  ASSERT_FALSE(receiver.due(1s).empty());
  EXPECT_EQ(receiver.take(chunk_of({kMap, 1}, map, 0), 1s + 1ms), std::nullopt);
  receiver.offer({kMap, 1, 2});
  receiver.offer({kMap, 1, 3});
  EXPECT_EQ(fetch_all(receiver, map.size(), 2s), (std::vector<ItemId>{{kMap, 1}, {kMap, 3}}));
}

TEST(Receiver, GivesUpWhatTheWriterDoesNotHave) {
  Receiver receiver;
  receiver.want(kImages, false);
  receiver.offer({kImages, 4, 4});
  ASSERT_EQ(receiver.due(1s).size(), 1U);
  EXPECT_EQ(receiver.take({{kImages, 4}, 0, 0, {}}, 1s), std::nullopt);
  EXPECT_EQ(receiver.lacking(kImages), 0U);
  EXPECT_EQ(receiver.statistics().absent, 1U);
  EXPECT_EQ(receiver.next_due(), std::nullopt);
}

TEST(Receiver, AsksAgainForWhatIsLost) {
  Receiver receiver;
  receiver.want(kImages, false);
  receiver.offer({kImages, 0, 0});
  const std::vector<std::uint8_t> item(5 * kChunkBytes, 1);
  receiver.due(1s);
  for (const std::uint32_t index : {0U, 1U, 3U, 4U})
    receiver.take(chunk_of({kImages, 0}, item, index), 1s + 10ms);
  ASSERT_TRUE(receiver.next_due());
  const auto requests = receiver.due(*receiver.next_due());
  ASSERT_EQ(requests.size(), 1U);
  EXPECT_EQ(requests[0].first, 2U);
  EXPECT_EQ(requests[0].count, 1U);
  EXPECT_TRUE(receiver.take(chunk_of({kImages, 0}, item, 2), 1s + 60ms));
  EXPECT_EQ(receiver.statistics().asked_again, 1U);
}

TEST(Receiver, AsksOnceASecondWhereNobodyAnswers) {
  Receiver receiver;
  receiver.want(kImages, false);
  receiver.offer({kImages, 0, 40});
  std::size_t asked = 0;
  Time now = 1s;
  for (int i = 0; i < 60; ++i) {
    for (const Request& request : receiver.due(now)) asked += request.count;
    now = receiver.next_due().value();
  }
  EXPECT_GE(now, 50s);
  EXPECT_LE(asked, 32U + 60U * 4U);
}

TEST(Receiver, AnOfferOfAnyNumbersIsBounded) {
  Receiver receiver;
  receiver.want(kImages, false);
  receiver.offer({kImages, 0, ~std::uint64_t{0} - 1});
  EXPECT_LE(receiver.lacking(kImages), 100'000U);
  receiver.offer({kImages, 9, 3});
  EXPECT_LE(receiver.lacking(kImages), 100'000U);
}

}  // namespace
}  // namespace rds::transfer
