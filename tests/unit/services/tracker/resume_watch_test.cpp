// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/resume_watch.hpp"

#include <gtest/gtest.h>

namespace rds::tracker {
namespace {

constexpr std::int64_t kFrame = 33'000'000;

/// Frames until the map is given up; -1 if it is not in so many.
int frames_until_given_up(ResumeWatch& watch, int frames, bool is_usable) {
  for (int i = 0; i < frames; ++i)
    if (watch.take(i * kFrame, false, is_usable)) return i;
  return -1;
}

TEST(ResumeWatch, GivesUpAfterItsPatienceInUsablePictures) {
  ResumeWatch watch(5);
  watch.begin();
  EXPECT_NEAR(frames_until_given_up(watch, 1000, true), 152, 2);
}

TEST(ResumeWatch, DarkPicturesDoNotCount) {
  ResumeWatch watch(5);
  watch.begin();
  EXPECT_EQ(frames_until_given_up(watch, 1000, false), -1);
}

TEST(ResumeWatch, AGapIsNoSearch) {
  ResumeWatch watch(5);
  watch.begin();
  EXPECT_FALSE(watch.take(0, false, true));
  EXPECT_FALSE(watch.take(100'000'000'000, false, true));
  EXPECT_FALSE(watch.take(0, false, true)) << "nor is a clock that was set";
}

TEST(ResumeWatch, WhoHasFoundItselfIsNoLongerWatched) {
  ResumeWatch watch(5);
  watch.begin();
  EXPECT_TRUE(watch.is_looking());
  EXPECT_FALSE(watch.take(0, true, true));
  EXPECT_FALSE(watch.is_looking());
  EXPECT_EQ(frames_until_given_up(watch, 1000, true), -1);
}

TEST(ResumeWatch, NeverGivesUpWithoutPatience) {
  ResumeWatch watch(0);
  watch.begin();
  EXPECT_EQ(frames_until_given_up(watch, 1000, true), -1);
}

}  // namespace
}  // namespace rds::tracker
