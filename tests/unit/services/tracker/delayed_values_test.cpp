// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/delayed_values.hpp"

#include <gmock/gmock.h>

namespace rds::tracker {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(DelayedValues, TakeEffectAtTheFrameAgreedOnWhateverTheOrderOfArrival) {
  DelayedValues<int> values;
  values.ask(7, 2);
  values.ask(8, 4);
  EXPECT_TRUE(values.arrive(8, 80));
  EXPECT_FALSE(values.complete(2));
  EXPECT_TRUE(values.arrive(7, 70));
  EXPECT_TRUE(values.complete(2));
  EXPECT_THAT(values.take_due(1), IsEmpty());
  EXPECT_THAT(values.take_due(2), ElementsAre(70));
  EXPECT_THAT(values.take_due(3), IsEmpty());
  EXPECT_THAT(values.take_due(4), ElementsAre(80));
}

TEST(DelayedValues, GiveUpWhatIsMissingWhenDueAndRefuseItLater) {
  DelayedValues<int> values;
  values.ask(1, 2);
  EXPECT_THAT(values.take_due(2), IsEmpty());
  EXPECT_EQ(values.missed(), 1U);
  EXPECT_FALSE(values.arrive(1, 10));
}

TEST(DelayedValues, InRealTimeTakeWhatIsThereAndForgetOlderQuestions) {
  DelayedValues<int> values;
  for (std::uint64_t key : {1U, 2U, 3U}) values.ask(key, 100);
  EXPECT_TRUE(values.arrive(2, 20));
  EXPECT_THAT(values.take_arrived(), ElementsAre(20));
  EXPECT_EQ(values.missed(), 1U);
  EXPECT_FALSE(values.arrive(1, 10));
  EXPECT_TRUE(values.arrive(3, 30));
  EXPECT_THAT(values.take_arrived(), ElementsAre(30));
}

TEST(DelayedValues, ALaterAnswerStandsInForEarlierOnesThatGotLost) {
  DelayedValues<int> values;
  for (std::uint64_t key : {1U, 2U, 3U}) values.ask(key, key);
  EXPECT_TRUE(values.arrive(1, 10));
  values.arrive_through(2, 20);
  EXPECT_TRUE(values.complete(2));
  EXPECT_FALSE(values.complete(3));
  EXPECT_THAT(values.take_due(2), ElementsAre(10, 20));
}

TEST(DelayedValues, RefuseWhatNobodyAskedFor) {
  DelayedValues<int> values;
  EXPECT_FALSE(values.arrive(5, 50));
}

TEST(DelayedValues, QuestionsThatNobodyAnswersAreBounded) {
  DelayedValues<int> values;
  constexpr std::uint64_t kMore = 500;
  for (std::uint64_t key = 0; key < DelayedValues<int>::kMaxWaiting + kMore; ++key) values.ask(key, key + 2);
  EXPECT_EQ(values.size(), DelayedValues<int>::kMaxWaiting);
  EXPECT_EQ(values.missed(), kMore);
  EXPECT_FALSE(values.arrive(0, 1)) << "the oldest are given up";
  EXPECT_TRUE(values.arrive(kMore, 1));
}

}  // namespace
}  // namespace rds::tracker
