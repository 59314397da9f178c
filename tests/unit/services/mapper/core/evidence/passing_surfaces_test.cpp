// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/passing_surfaces.hpp"

#include <gtest/gtest.h>

#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::SyntheticKeyframe;

constexpr double kDepthM = 1.52;
constexpr int kWidth = 320;
const cv::Rect kBody(120, 30, 80, 180);

/// Somebody is known in keyframes 0 and 2; of keyframe 1 nobody is.
class PassingSurfaces : public testing::Test {
 protected:
  PassingSurfaces() {
    for (const std::uint64_t keyframe : {0, 2})
      see(SyntheticKeyframe(keyframe).rectangle(kBody, kDepthM).box("person", kBody, true));
  }
  /// Use of a pixel of keyframe 1.
  PixelUse use_at(const SyntheticKeyframe& keyframe, int u, int v) {
    const KeyframeRecord record = see(keyframe);
    std::vector<PixelUse> use = record.use;
    leave_out_passing(record, history_, config_, use);
    const int stride = config_.sampling.stride_px;
    return use[static_cast<std::size_t>(v / stride * (kWidth / stride) + u / stride)];
  }

  MapperConfig config_;

 private:
  KeyframeRecord see(const KeyframeInput& input) {
    auto record = test::record_of(input, labels_, config_);
    history_.see(record, config_);
    return record;
  }

  LabelTable labels_;
  SceneHistory history_{{}, MovableHistory(config_.octree.resolution_m)};
};

TEST_F(PassingSurfaces, WhoIsNotKnownInAKeyframeIsLeftOut) {
  const auto keyframe = SyntheticKeyframe(1).rectangle(kBody, kDepthM);
  EXPECT_EQ(use_at(keyframe, 160, 120), PixelUse::kNone);
  EXPECT_EQ(use_at(keyframe, 20, 120), PixelUse::kStatic) << "the wall";
}

TEST_F(PassingSurfaces, WhatGoesOnBesideHimStays) {
  EXPECT_EQ(use_at(SyntheticKeyframe(1).rectangle({60, 30, 200, 180}, kDepthM), 160, 120), PixelUse::kStatic);
}

TEST_F(PassingSurfaces, AnObjectThatTheDetectorFoundStays) {
  const auto keyframe = SyntheticKeyframe(1).rectangle(kBody, kDepthM).box("chair", kBody, false);
  EXPECT_EQ(use_at(keyframe, 160, 120), PixelUse::kStatic);
}

TEST_F(PassingSurfaces, TheShareTellsWhatGoesOn) {
  config_.confirmation.passing_share = 0.3;
  EXPECT_EQ(use_at(SyntheticKeyframe(1).rectangle({60, 30, 200, 180}, kDepthM), 160, 120), PixelUse::kNone);
}

}  // namespace
}  // namespace rds::mapper
