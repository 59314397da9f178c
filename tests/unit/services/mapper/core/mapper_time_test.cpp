// SPDX-License-Identifier: Apache-2.0
// Stamps of keyframes that go back: what is measured between sightings goes on.
#include <gtest/gtest.h>

#include "services/mapper/core/tree_bytes.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::SyntheticKeyframe;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::uint64_t kArrives = 5;
constexpr std::uint64_t kSetBack = 20;
constexpr std::uint64_t kLeaves = 38;
constexpr std::uint64_t kEnd = 41;

/// A wall before which somebody stands for 10 s, whom every other keyframe knows of; from keyframe kSetBack on
/// stamps are `later_ns` later.
std::vector<KeyframeInput> keyframes(std::int64_t later_ns) {
  std::vector<KeyframeInput> made;
  for (std::uint64_t k = 0; k < kEnd; ++k) {
    SyntheticKeyframe keyframe(k);
    keyframe.looked_for_objects();
    const cv::Rect body(120 + static_cast<int>(k % 3), 30, 80, 180);
    if (k >= kArrives && k < kLeaves) keyframe.rectangle(body, 1.5);
    if (k >= kArrives && k < kLeaves && k % 2 == 0) keyframe.box("person", body, true);
    made.push_back(keyframe.make());
    made.back().stamp_ns = 2'000'000 * kMs + static_cast<std::int64_t>(k) * 300 * kMs;
    if (k >= kSetBack) made.back().stamp_ns += later_ns;
  }
  return made;
}

const std::int64_t kSetBackBy = -1'000'000 * kMs;
const std::int64_t kAsIfLater = time::ContinuousTime::kUnknownNs - 300 * kMs;

std::vector<std::uint8_t> map_of(const std::vector<KeyframeInput>& inputs, MapperConfig config = {}) {
  SemanticMapper mapper(config);
  for (const KeyframeInput& input : inputs) mapper.integrate(input);
  return to_bytes(mapper.tree());
}

TEST(MapperTime, TheMapIsThatOfTimeThatGoesOn) {
  EXPECT_TRUE(map_of(keyframes(kSetBackBy)) == map_of(keyframes(kAsIfLater)));
}

TEST(MapperTime, SoItIsWhereTheOldestKeyframesAreFinal) {
  MapperConfig config;
  config.correction.max_keyframes = 10;
  EXPECT_TRUE(map_of(keyframes(kSetBackBy), config) == map_of(keyframes(kAsIfLater), config));
}

TEST(MapperTime, TheSettledMapDoesNotDependOnTheOrderOfArrival) {
  std::vector<KeyframeInput> inputs = keyframes(kSetBackBy);
  SemanticMapper in_order{MapperConfig{}};
  for (const KeyframeInput& input : inputs) in_order.integrate(input);
  in_order.settle({});
  SemanticMapper mixed{MapperConfig{}};
  std::swap(inputs[kSetBack - 1], inputs[kSetBack]);
  std::swap(inputs[3], inputs[30]);
  for (const KeyframeInput& input : inputs) mixed.integrate(input);
  mixed.settle({});
  EXPECT_TRUE(to_bytes(in_order.tree()) == to_bytes(mixed.tree()));
}

}  // namespace
}  // namespace rds::mapper
