// SPDX-License-Identifier: Apache-2.0
#include "common/concurrency/mailbox.hpp"

#include <thread>

#include <gtest/gtest.h>

namespace rds::concurrency {
namespace {

TEST(Inbox, DropsTheOldestWhenFullAndCounts) {
  Mailbox mailbox;
  Inbox<int> inbox(mailbox, 2);
  for (int i = 0; i < 5; ++i) inbox.push(i);
  EXPECT_EQ(inbox.dropped(), 3U);
  EXPECT_EQ(inbox.try_pop(), 3);
  EXPECT_EQ(inbox.try_pop(), 4);
  EXPECT_EQ(inbox.try_pop(), std::nullopt);
}

TEST(Inbox, TryPushRefusesWhenFullAndKeepsWhatIsThere) {
  Mailbox mailbox;
  Inbox<int> inbox(mailbox, 2);
  EXPECT_TRUE(inbox.try_push(1));
  EXPECT_TRUE(inbox.try_push(2));
  EXPECT_FALSE(inbox.try_push(3));
  EXPECT_EQ(inbox.dropped(), 0U);
  EXPECT_EQ(inbox.try_pop(), 1);
  EXPECT_EQ(inbox.try_pop(), 2);
}

TEST(Inbox, PushWhenFreeWaitsForRoomAndLosesNothing) {
  Mailbox mailbox;
  Inbox<int> inbox(mailbox, 3);
  std::jthread producer([&] {
    for (int i = 0; i < 1000; ++i) inbox.push_when_free(i);
  });
  for (int next = 0; next < 1000;) {
    EXPECT_LE(inbox.size(), 3U);
    if (const auto value = inbox.try_pop()) {
      EXPECT_EQ(*value, next++);
    }
  }
  EXPECT_EQ(inbox.dropped(), 0U);
}

TEST(Inbox, TheNewestIsTakenAndTheOthersStay) {
  Mailbox mailbox;
  Inbox<int> inbox(mailbox, 10);
  for (int i = 0; i < 4; ++i) inbox.push(i);
  EXPECT_EQ(inbox.try_pop_newest(), 3);
  EXPECT_EQ(inbox.dropped(), 0U);
  EXPECT_EQ(inbox.try_pop(), 0);
  EXPECT_EQ(inbox.try_pop_newest(), 2);
  EXPECT_EQ(inbox.size(), 1U);
}

TEST(Mailbox, WorkerWakesForEitherInboxAndTakesEverythingInOrder) {
  Mailbox mailbox;
  Inbox<int> numbers(mailbox, 10000);
  Inbox<char> letters(mailbox, 10000);
  std::jthread producer([&] {
    for (int i = 0; i < 1000; ++i) {
      numbers.push(i);
      letters.push('x');
    }
  });
  int next = 0;
  int letters_taken = 0;
  while (next < 1000 || letters_taken < 1000) {
    ASSERT_TRUE(mailbox.wait({}, [&] { return !numbers.locked_empty() || !letters.locked_empty(); }));
    if (const auto number = numbers.try_pop()) {
      EXPECT_EQ(*number, next++);
    }
    if (letters.try_pop()) ++letters_taken;
  }
}

TEST(Mailbox, StopAndTimeoutEndAWait) {
  Mailbox mailbox;
  const Inbox<int> inbox(mailbox, 1);
  std::stop_source stop;
  std::jthread stopper([&stop] { stop.request_stop(); });
  EXPECT_FALSE(mailbox.wait(stop.get_token(), [&] { return !inbox.locked_empty(); }));
  EXPECT_FALSE(mailbox.wait_for({}, std::chrono::milliseconds(5), [&] { return !inbox.locked_empty(); }));
}

}  // namespace
}  // namespace rds::concurrency
