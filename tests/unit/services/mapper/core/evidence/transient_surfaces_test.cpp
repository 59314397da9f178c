// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "services/mapper/core/evidence/surface_rules.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::SyntheticKeyframe;

constexpr double kDepthM = 1.52;
constexpr int kWidth = 320;
const cv::Rect kBody(120, 30, 80, 180);

/// Somebody is known in keyframes 0 and 2; of keyframe 1 nobody is.
class TransientSurfaces : public testing::Test {
 protected:
  TransientSurfaces() {
    for (const std::uint64_t keyframe : {0, 2})
      see(SyntheticKeyframe(keyframe).rectangle(kBody, kDepthM).box("person", kBody, true));
  }
  /// Class of a pixel of keyframe 1.
  PixelClass class_at(const SyntheticKeyframe& keyframe, int u, int v) {
    const KeyframeRecord record = see(keyframe);
    const PixelClasses classes = resolve(record, history_, config_);
    const int stride = config_.sampling.stride_px;
    return classes[static_cast<std::size_t>(v / stride * (kWidth / stride) + u / stride)];
  }

  MapperConfig config_;

 private:
  KeyframeRecord see(const KeyframeInput& input) {
    auto record = test::record_of(input, labels_, config_);
    history_.see(record, config_);
    return record;
  }

  LabelTable labels_;
  SceneHistory history_{{}, DynamicHistory(config_.octree.resolution_m)};
};

TEST_F(TransientSurfaces, WhoIsNotKnownInAKeyframeIsLeftOut) {
  const auto keyframe = SyntheticKeyframe(1).rectangle(kBody, kDepthM);
  EXPECT_EQ(class_at(keyframe, 160, 120), PixelClass::kInvalid);
  EXPECT_EQ(class_at(keyframe, 20, 120), PixelClass::kStatic) << "the wall";
}

TEST_F(TransientSurfaces, WhatGoesOnBesideHimStays) {
  EXPECT_EQ(class_at(SyntheticKeyframe(1).rectangle({60, 30, 200, 180}, kDepthM), 160, 120),
            PixelClass::kStatic);
}

TEST_F(TransientSurfaces, AnObjectThatTheDetectorFoundStays) {
  const auto keyframe = SyntheticKeyframe(1).rectangle(kBody, kDepthM).box("chair", kBody, false);
  EXPECT_EQ(class_at(keyframe, 160, 120), PixelClass::kStatic);
}

TEST_F(TransientSurfaces, TheShareTellsWhatGoesOn) {
  config_.confirmation.transient_share = 0.3;
  EXPECT_EQ(class_at(SyntheticKeyframe(1).rectangle({60, 30, 200, 180}, kDepthM), 160, 120),
            PixelClass::kInvalid);
}

}  // namespace
}  // namespace rds::mapper
