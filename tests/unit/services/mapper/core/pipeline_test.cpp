// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/pipeline.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "services/mapper/core/segmentation/object_place.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::record_of;
using test::SyntheticKeyframe;

PixelClass class_at(const KeyframeRecord& record, int x_px, int y_px) {
  return record.classes[record.grid.index(x_px / record.grid.stride, y_px / record.grid.stride)];
}

TEST(Pipeline, CutsAPersonOutOfHisBoxAndLeavesARimUnknown) {
  const cv::Rect person(120, 40, 80, 200);
  LabelTable labels;
  const auto record = record_of(
      SyntheticKeyframe(0).rectangle(person, 1.5).box("person", {90, 20, 140, 220}, true).make(), labels);
  EXPECT_EQ(class_at(record, 160, 120), PixelClass::kDynamic);
  EXPECT_EQ(class_at(record, 116, 120), PixelClass::kUnknown);
  EXPECT_EQ(class_at(record, 95, 120), PixelClass::kStatic);
  EXPECT_TRUE(record.objects.sightings.empty());
}

TEST(Pipeline, AWallThatGoesOnOutsideABoxIsOfNobodyInIt) {
  const cv::Rect person(140, 40, 40, 180);
  LabelTable labels;
  const auto record = record_of(
      SyntheticKeyframe(0, 1.7).rectangle(person, 1.5).box("person", {130, 30, 60, 200}, true).make(),
      labels);
  EXPECT_EQ(class_at(record, 160, 120), PixelClass::kDynamic);
  EXPECT_EQ(class_at(record, 132, 120), PixelClass::kStatic);  // inside the box, and as near as he may be
  EXPECT_EQ(class_at(record, 60, 120), PixelClass::kStatic);
}

TEST(Pipeline, AWallThatFillsNoMoreThanABoxMayBeSomebody) {
  LabelTable labels;
  const auto record = record_of(SyntheticKeyframe(0, 5.9)
                                    .rectangle({90, 0, 150, 240}, 1.5)
                                    .box("person", {90, 0, 150, 240}, true)
                                    .make(),
                                labels);
  EXPECT_EQ(class_at(record, 160, 120), PixelClass::kDynamic);
  EXPECT_EQ(class_at(record, 100, 20), PixelClass::kDynamic);
}

TEST(Pipeline, WhatHasAnotherColourBesideAPersonsBoxIsNotHis) {
  const cv::Rect person(120, 40, 80, 180);
  const cv::Rect bag(215, 150, 14, 30);
  LabelTable labels;
  const auto record = record_of(SyntheticKeyframe(0)
                                    .rectangle(person, 1.5)
                                    .rectangle(bag, 1.6, {60, 160, 60})
                                    .box("person", {110, 30, 100, 200}, true)
                                    .make(),
                                labels);
  EXPECT_EQ(class_at(record, 160, 120), PixelClass::kDynamic);
  EXPECT_EQ(class_at(record, 222, 164), PixelClass::kDoubtful);
}

TEST(Pipeline, AnObjectIsLookedForAtItsOwnDepthNotOnTheWallBehind) {
  const cv::Rect chair(130, 90, 60, 60);
  LabelTable labels;
  auto input = SyntheticKeyframe(0).rectangle(chair, 2.0).looked_for_objects().make();
  input.boxes->push_back({"chair", 0.9F, {100, 60, 220, 180}, std::nullopt, 2.0F, false});
  const auto record = record_of(input, labels);
  ASSERT_EQ(record.objects.sightings.size(), 1U);
  for (const auto& p : record.objects.sightings[0].points_in_camera) EXPECT_NEAR(p.z(), 2.0F, 0.1F);
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (record.objects.labels[i] == 0) continue;
    EXPECT_NEAR(record.depth_m(i), 2.0F, 0.1F);
  }
}

TEST(Pipeline, MovableCellsAreUnknownUnlessABoxKnowsTheObject) {
  const cv::Rect person(120, 40, 80, 200);
  auto keyframe = SyntheticKeyframe(0)
                      .rectangle(person, 1.5)
                      .rectangle({40, 40, 80, 80}, 2.5, {60, 160, 60})
                      .movable_cells({40, 40, 80, 80});
  const MapperConfig config;
  LabelTable labels;
  const auto unboxed = record_of(keyframe, labels, config);
  EXPECT_EQ(class_at(unboxed, 60, 60), PixelClass::kUnknown);
  EXPECT_EQ(class_at(unboxed, 60, 140), PixelClass::kDoubtful);
  keyframe.movable_cells({160, 120, 40, 40});
  const auto boxed = record_of(keyframe.box("person", {90, 20, 140, 220}, true).make(), labels);
  EXPECT_EQ(class_at(boxed, 180, 140), PixelClass::kDynamic);
  EXPECT_EQ(class_at(boxed, 60, 60), PixelClass::kUnknown);
}

TEST(Pipeline, TheHigherScoreHasThePixel) {
  const cv::Rect thing(110, 80, 100, 80);
  LabelTable labels;
  const auto record = record_of(SyntheticKeyframe(0)
                                    .rectangle(thing, 2.0)
                                    .box("sofa", thing, false, 0.9F)
                                    .box("chair", thing, false, 0.4F)
                                    .make(),
                                labels);
  const auto center = record.grid.index(160 / record.grid.stride, 120 / record.grid.stride);
  EXPECT_EQ(labels.names()[record.objects.labels[center]], "sofa");
}

TEST(Pipeline, WhatIsFlushWithAWallIsAnObjectOnlyByAHighScore) {
  const cv::Rect poster(110, 80, 100, 80);
  const auto sightings = [&](double depth_m, float score) {
    LabelTable labels;
    return record_of(
               SyntheticKeyframe(0).rectangle(poster, depth_m).box("tvmonitor", poster, false, score).make(),
               labels)
        .objects.sightings.size();
  };
  EXPECT_EQ(sightings(2.97, 0.65F), 0U);
  EXPECT_EQ(sightings(2.97, 0.75F), 1U);
  EXPECT_EQ(sightings(2.8, 0.45F), 1U);
}

TEST(Pipeline, NewBoxesReplaceEarlierOnes) {
  const cv::Rect person(120, 40, 80, 200);
  LabelTable labels;
  auto record =
      record_of(SyntheticKeyframe(0).rectangle(person, 1.5).box("person", person, true).make(), labels);
  interpret(record, std::span<const LabelledBox>{}, MapperConfig{}, labels);
  EXPECT_EQ(std::ranges::count(record.classes, PixelClass::kDynamic), 0);
  EXPECT_EQ(class_at(record, 160, 120), PixelClass::kStatic);
}

TEST(Pipeline, ABoxWithoutDepthHasNoPlace) {
  LabelTable labels;
  const auto record =
      record_of(SyntheticKeyframe(0).rectangle({100, 50, 100, 100}, 0).looked_for_objects().make(), labels);
  const LabelledBox box{"person", 1.0F, {110, 60, 190, 140}, std::nullopt, 0.0F, true};
  EXPECT_FALSE(object_place(record, box).has_value());
}

}  // namespace
}  // namespace rds::mapper
