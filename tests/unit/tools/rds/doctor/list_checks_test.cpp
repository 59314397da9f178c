// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/list_checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rds::doctor {
namespace {
using testing::HasSubstr;
constexpr std::int64_t kPeriodNs = 33'000'000;

RecordingLists even_lists(std::size_t frames) {
  RecordingLists lists;
  lists.depth_pictures = frames;
  for (std::size_t i = 0; i < frames; ++i) {
    lists.frames.push_back(1'000'000'000 + static_cast<std::int64_t>(i) * kPeriodNs);
    lists.depth_after.push_back(i % 2 == 0 ? 2'000'000 : -2'000'000);
  }
  lists.truth = lists.frames;
  return lists;
}

TEST(ListChecks, FindNothingWrongWithEvenLists) {
  const auto lists = even_lists(20);
  for (const auto& finding : {check_counts(lists), check_files(lists), check_pairing(lists, 525),
                              check_rate(lists, 30), check_gaps(lists), check_truth(lists)})
    EXPECT_EQ(finding.verdict, Verdict::kGood) << finding.subject << ": " << finding.sentence;
}

TEST(ListChecks, CountColourWithoutDepth) {
  auto lists = even_lists(100);
  lists.depth_after.resize(98);
  EXPECT_EQ(check_counts(lists).verdict, Verdict::kHint);
  EXPECT_THAT(check_counts(lists).sentence, HasSubstr("colour pictures without depth within 20 ms: 2"));
  lists.depth_after.resize(80);
  EXPECT_EQ(check_counts(lists).verdict, Verdict::kFault);
}

TEST(ListChecks, CountStampsGivenTwice) {
  auto lists = even_lists(100);
  lists.repeated = 3;
  EXPECT_EQ(check_counts(lists).verdict, Verdict::kHint);
  EXPECT_THAT(check_counts(lists).sentence, HasSubstr("stamps given twice: 3"));
}

TEST(ListChecks, NameTheFirstMissingFile) {
  auto lists = even_lists(100);
  lists.missing = {"rgb/a.png", "depth/b.png"};
  EXPECT_EQ(check_files(lists).verdict, Verdict::kHint);
  EXPECT_THAT(check_files(lists).sentence,
              HasSubstr("2 of 200 listed pictures are missing, the first is rgb/a.png"));
}

TEST(ListChecks, SayWhatAnOffsetOfDepthMeansInPixels) {
  auto lists = even_lists(20);
  for (auto& offset : lists.depth_after) offset = -15'000'000;
  lists.depth_after[3] = 18'000'000;
  const auto finding = check_pairing(lists, 525);
  EXPECT_EQ(finding.verdict, Verdict::kHint);
  EXPECT_THAT(finding.sentence, HasSubstr("15.0 ms from colour in the median, 18.0 ms at most"));
  EXPECT_THAT(finding.sentence, HasSubstr("4 px off when the camera turns at 30°/s"));
}

TEST(ListChecks, FindAnotherAndAnUnevenRate) {
  auto lists = even_lists(40);
  EXPECT_EQ(check_rate(lists, 15).verdict, Verdict::kHint);
  for (std::size_t i = 0; i < lists.frames.size(); i += 5) lists.frames[i] += 12'000'000;
  const auto finding = check_rate(lists, 30);
  EXPECT_EQ(finding.verdict, Verdict::kHint);
  EXPECT_THAT(finding.sentence, HasSubstr("38.5 % of the intervals are uneven"));
}

TEST(ListChecks, FindGapsOfMoreThanThreePeriods) {
  auto lists = even_lists(20);
  for (std::size_t i = 10; i < 20; ++i) lists.frames[i] += kPeriodNs;
  EXPECT_EQ(check_gaps(lists).verdict, Verdict::kGood);
  for (std::size_t i = 10; i < 20; ++i) lists.frames[i] += 3 * kPeriodNs;
  EXPECT_EQ(check_gaps(lists).verdict, Verdict::kHint);
  EXPECT_THAT(check_gaps(lists).sentence, HasSubstr("1 of more than 99 ms, the longest 165 ms after 1.297"));
  lists.frames.back() += 1'000'000'000;
  EXPECT_EQ(check_gaps(lists).verdict, Verdict::kFault);
}

TEST(ListChecks, OneFrameIsAFault) {
  EXPECT_EQ(check_rate(even_lists(1), 30).verdict, Verdict::kFault);
  EXPECT_EQ(check_gaps(even_lists(1)).verdict, Verdict::kGood);
  EXPECT_EQ(check_pairing(even_lists(1), 525).verdict, Verdict::kGood);
}

TEST(ListChecks, TellMissingFromForeignTruth) {
  auto lists = even_lists(20);
  for (auto& stamp : *lists.truth) stamp += 5'000'000'000;
  EXPECT_EQ(check_truth(lists).verdict, Verdict::kFault);
  lists.truth.reset();
  EXPECT_EQ(check_truth(lists).verdict, Verdict::kHint);
}

}  // namespace
}  // namespace rds::doctor
