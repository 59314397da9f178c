// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/background/keyframe_pictures.hpp"

#include <atomic>
#include <chrono>
#include <map>
#include <thread>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace rds::tracker {
namespace {

constexpr std::size_t kPictures = 60;  // more than after which what is not used leaves memory

/// A picture of 64×48 that no other one is like.
Picture picture_of(KeyframeId keyframe) {
  cv::Mat gray(48, 64, CV_8UC1);
  cv::RNG random(keyframe);
  random.fill(gray, cv::RNG::UNIFORM, 0, 256);
  return std::make_shared<const ImagePyramid>(gray, 3);
}

bool are_equal(const ImagePyramid& a, const ImagePyramid& b) {
  bool equal = a.levels() == b.levels();
  for (int l = 0; equal && l < a.levels(); ++l) equal = cv::norm(a.level(l), b.level(l), cv::NORM_INF) == 0;
  return equal;
}

/// All that are moved, by keyframe; as many as come within a while.
std::map<KeyframeId, KeyframePictures::Moved> take(KeyframePictures& pictures, std::size_t wanted) {
  std::map<KeyframeId, KeyframePictures::Moved> moved;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (moved.size() < wanted && std::chrono::steady_clock::now() < deadline) {
    while (auto one = pictures.try_pop()) moved[one->keyframe] = std::move(*one);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return moved;
}

TEST(KeyframePictures, AreTheSameAfterTheyWereMoved) {
  KeyframePictures pictures(0);
  std::map<KeyframeId, Picture> given;
  for (KeyframeId k = 0; k < kPictures; ++k) {
    given[k] = picture_of(k);
    pictures.move(k, given[k]);
  }
  const auto moved = take(pictures, kPictures);
  ASSERT_EQ(moved.size(), given.size());
  for (const auto& [keyframe, m] : moved) {
    EXPECT_EQ(m.before, given[keyframe]) << "so that its owner knows which one to replace";
    EXPECT_NE(m.now, m.before);
    EXPECT_TRUE(are_equal(*m.now, *picture_of(keyframe)));
  }
}

TEST(KeyframePictures, OutlastWhoMovedThem) {
  std::map<KeyframeId, KeyframePictures::Moved> moved;
  {
    KeyframePictures pictures(0);
    pictures.move(7, picture_of(7));
    moved = take(pictures, 1);
  }
  ASSERT_EQ(moved.size(), 1U);
  EXPECT_TRUE(are_equal(*moved.at(7).now, *picture_of(7)));
}

TEST(KeyframePictures, AreReadWhileOthersAreMoved) {
  KeyframePictures pictures(0);
  pictures.move(0, picture_of(0));
  const auto first = take(pictures, 1);
  ASSERT_EQ(first.size(), 1U);
  const Picture expected = picture_of(0);
  std::atomic<int> differences = 0;
  const std::jthread reader([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) differences += are_equal(*first.at(0).now, *expected) ? 0 : 1;
  });
  for (KeyframeId k = 1; k <= kPictures; ++k) pictures.move(k, picture_of(k));
  EXPECT_EQ(take(pictures, kPictures).size(), kPictures);
  EXPECT_EQ(differences, 0);
}

}  // namespace
}  // namespace rds::tracker
