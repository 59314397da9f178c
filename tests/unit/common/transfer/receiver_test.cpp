// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/receiver.hpp"

#include <gtest/gtest.h>

namespace rds::transfer {
namespace {

using namespace std::chrono_literals;

using Numbers = std::vector<std::uint64_t>;

/// Answers everything at once.
Numbers fetch_all(Receiver& receiver, std::size_t bytes, Time now = 1s) {
  const std::vector<std::uint8_t> item(bytes, 1);
  Numbers whole;
  for (auto requests = receiver.due(now); !requests.empty(); requests = receiver.due(now)) {
    now += 1ms;
    for (const Request& request : requests)
      for (std::uint32_t i = request.first; i < std::min(request.first + request.count, chunks_in(bytes));
           ++i)
        if (const auto taken = receiver.take(chunk_of(request.number, item, i), now))
          whole.push_back(taken->number);
  }
  return whole;
}

TEST(Receiver, FetchesTheNewestFirst) {
  Receiver receiver(Order::kNewest);
  receiver.offer({3, 5}, {});
  EXPECT_EQ(fetch_all(receiver, 100'000), (Numbers{5, 4, 3}));
  receiver.offer({3, 7}, {});
  EXPECT_EQ(fetch_all(receiver, 100'000), (Numbers{7, 6}));
  EXPECT_EQ(receiver.lacking(), 0U);
  EXPECT_EQ(receiver.next_due(), std::nullopt);
}

TEST(Receiver, FinishesWhatItHasBegunBeforeTheNewest) {
  Receiver receiver(Order::kNewest);
  receiver.offer({1, 1}, {});
  const std::vector<std::uint8_t> item(100 * kChunkBytes, 1);
  ASSERT_FALSE(receiver.due(1s).empty());
  EXPECT_EQ(receiver.take(chunk_of(1, item, 0), 1s + 1ms), std::nullopt);
  receiver.offer({1, 3}, {});
  EXPECT_EQ(fetch_all(receiver, item.size(), 2s), (Numbers{1, 3, 2}));
}

TEST(Receiver, KeepsTheOrderOfNumbersWhereThatIsAskedFor) {
  Receiver receiver(Order::kNumber);
  receiver.offer({3, 5}, {});
  const std::vector<std::uint8_t> item(2 * kChunkBytes, 1);
  receiver.due(1s);
  receiver.take(chunk_of(3, item, 0), 1s + 10ms);  // the other chunk is lost
  EXPECT_TRUE(receiver.due(1s + 10ms).empty()) << "no other item is begun meanwhile";
  receiver.offer({3, 6}, {});
  EXPECT_EQ(fetch_all(receiver, item.size(), 9s), (Numbers{3, 4, 5, 6}));
}

TEST(Receiver, WithoutRoomOnlyWhatIsBegunIsFinished) {
  Receiver receiver(Order::kNewest);
  receiver.offer({1, 3}, {});
  EXPECT_TRUE(receiver.due(1s, false).empty());
  const std::vector<std::uint8_t> item(100 * kChunkBytes, 1);
  ASSERT_FALSE(receiver.due(1s).empty());
  receiver.take(chunk_of(3, item, 0), 1s + 1ms);
  for (const Request& request : receiver.due(1s + 1ms, false)) EXPECT_EQ(request.number, 3U);
}

TEST(Receiver, AsksForNothingTwice) {
  Receiver receiver(Order::kNewest);
  receiver.offer({0, 2}, {});
  EXPECT_EQ(fetch_all(receiver, 10), (Numbers{2, 1, 0}));
  receiver.offer({0, 2}, {});
  EXPECT_TRUE(receiver.due(9s).empty()) << "the same offer again";
}

TEST(Receiver, WhatIsOfferedNoMoreIsGivenUp) {
  Receiver receiver(Order::kNewest);
  receiver.offer({1, 1}, {});
  ASSERT_FALSE(receiver.due(1s).empty());
  receiver.offer({4, 5}, {});
  EXPECT_EQ(fetch_all(receiver, 10, 2s), (Numbers{5, 4}));
  EXPECT_EQ(receiver.statistics().given_up, 1U);
  EXPECT_EQ(receiver.statistics().items, 2U);
}

TEST(Receiver, CountsWhatCannotBeHadAnyMore) {
  Receiver receiver(Order::kNewest);
  receiver.offer({10, 12, 7}, {});
  EXPECT_EQ(receiver.statistics().given_up, 7U) << "of before it came";
  ASSERT_FALSE(receiver.due(1s).empty());
  receiver.take({11, kLost, 0, {}}, 1s);
  EXPECT_EQ(receiver.statistics().given_up, 8U);
  EXPECT_EQ(receiver.lacking(), 2U);
  receiver.offer({12, 13, 9}, 1s);
  EXPECT_EQ(receiver.statistics().given_up, 9U) << "and the tenth, which was asked for";
  EXPECT_EQ(fetch_all(receiver, 10, 2s), (Numbers{12, 13})) << "the one that was begun first";
  EXPECT_EQ(receiver.statistics().given_up, 9U);
}

TEST(Receiver, TellsWhatShouldBeHereByNow) {
  Receiver receiver(Order::kNewest);
  receiver.offer({0, 2}, 1s);
  receiver.offer({0, 3}, 2s);
  EXPECT_EQ(receiver.overdue(2s), 0U);
  EXPECT_EQ(receiver.next_overdue(2s), 2500ms);
  EXPECT_EQ(receiver.overdue(2500ms), 3U);
  EXPECT_EQ(receiver.next_overdue(2500ms), 3500ms);
  receiver.offer({0, 3}, 3s);
  EXPECT_EQ(receiver.overdue(3500ms), 4U) << "offered again, it waits no less";
  fetch_all(receiver, 10, 4s);
  EXPECT_EQ(receiver.overdue(5s), 0U);
  EXPECT_EQ(receiver.next_overdue(5s), std::nullopt);
}

TEST(Receiver, GivesUpWhatTheWriterDoesNotHave) {
  Receiver receiver(Order::kNewest);
  receiver.offer({4, 4}, {});
  ASSERT_EQ(receiver.due(1s).size(), 1U);
  EXPECT_EQ(receiver.take({4, 0, 0, {}}, 1s), std::nullopt);
  EXPECT_EQ(receiver.lacking(), 0U);
  EXPECT_EQ(receiver.statistics().absent, 1U);
  EXPECT_EQ(receiver.statistics().given_up, 0U) << "there never was one";
  EXPECT_EQ(receiver.next_due(), std::nullopt);
}

TEST(Receiver, AsksAgainForWhatIsLost) {
  Receiver receiver(Order::kNewest);
  receiver.offer({0, 0}, {});
  const std::vector<std::uint8_t> item(5 * kChunkBytes, 1);
  receiver.due(1s);
  for (const std::uint32_t index : {0U, 1U, 3U, 4U}) receiver.take(chunk_of(0, item, index), 1s + 10ms);
  ASSERT_TRUE(receiver.next_due());
  const auto requests = receiver.due(*receiver.next_due());
  ASSERT_EQ(requests.size(), 1U);
  EXPECT_EQ(requests[0].first, 2U);
  EXPECT_EQ(requests[0].count, 1U);
  EXPECT_TRUE(receiver.take(chunk_of(0, item, 2), 1s + 60ms));
  EXPECT_EQ(receiver.statistics().asked_again, 1U);
}

TEST(Receiver, AsksOnceASecondWhereNobodyAnswers) {
  Receiver receiver(Order::kNewest);
  receiver.offer({0, 40}, {});
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
  Receiver receiver(Order::kNewest);
  receiver.offer({0, ~std::uint64_t{0} - 1}, {});
  EXPECT_LE(receiver.lacking(), 100'000U);
  receiver.offer({9, 3}, {});
  EXPECT_LE(receiver.lacking(), 100'000U);
}

}  // namespace
}  // namespace rds::transfer
