// SPDX-License-Identifier: Apache-2.0
// Stamps of keyframes that go back: what is measured between sightings goes on.
#include <gtest/gtest.h>

#include "services/mapper/core/octree/tree_bytes.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::SyntheticKeyframe;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::uint64_t kArrives = 5;  // keyframe
constexpr std::uint64_t kSetBack = 7;
constexpr std::uint64_t kEnd = 9;
constexpr std::int64_t kSetBackBy = -1'000'000 * kMs;
constexpr std::int64_t kAsIfLater = time::ContinuousTime::kUnknownNs - 300 * kMs;
constexpr std::int64_t kMuchLater = 10'000 * kMs;
const Eigen::Vector3d kBag = test::point_at(225, 180, 1.5);

/// A wall, before which somebody with a bag stands from keyframe kArrives on. From keyframe kSetBack on
/// stamps are `later_ns` later.
std::vector<KeyframeInput> keyframes(std::int64_t later_ns) {
  std::vector<KeyframeInput> made;
  for (std::uint64_t k = 0; k < kEnd; ++k) {
    SyntheticKeyframe keyframe(k);
    keyframe.looked_for_objects();
    const cv::Rect body(120, 30, 80, 180);
    if (k >= kArrives) keyframe.rectangle(body, 1.5).box("person", body, true);
    if (k >= kArrives) keyframe.rectangle({208, 150, 40, 60}, 1.5, {60, 160, 60});
    made.push_back(keyframe.make());
    made.back().stamp_ns = 2'000'000 * kMs + static_cast<std::int64_t>(k) * 300 * kMs;
    if (k >= kSetBack) made.back().stamp_ns += later_ns;
  }
  return made;
}

/// What stands near somebody counts when it has stood there for 3 s.
SemanticMapper make_mapper(int max_keyframes = 1000) {
  MapperConfig config;
  config.confirmation.apart_s = 3;
  config.correction.max_keyframes = max_keyframes;
  return SemanticMapper(config);
}

std::vector<std::uint8_t> map_of(const std::vector<KeyframeInput>& inputs, int max_keyframes = 1000) {
  SemanticMapper mapper = make_mapper(max_keyframes);
  for (const KeyframeInput& input : inputs) mapper.integrate(input);
  return to_bytes(mapper.map().tree());
}

bool bag_is_in_map(std::int64_t later_ns) {
  SemanticMapper mapper = make_mapper();
  for (const KeyframeInput& input : keyframes(later_ns)) mapper.integrate(input);
  mapper.settle({});
  return test::is_occupied(mapper.map().tree(), kBag);
}

TEST(MapperTime, AClockThatIsSetBackIsNotTakenForTimeThatPassed) {
  EXPECT_TRUE(bag_is_in_map(kMuchLater)) << "the test tests nothing";
  EXPECT_FALSE(bag_is_in_map(kAsIfLater));
  EXPECT_FALSE(bag_is_in_map(kSetBackBy));
}

TEST(MapperTime, TheMapIsThatOfTimeThatGoesOn) {
  EXPECT_TRUE(map_of(keyframes(kSetBackBy)) == map_of(keyframes(kAsIfLater)));
}

TEST(MapperTime, SoItIsWhereTheOldestKeyframesAreFinal) {
  constexpr int kKept = 2;
  EXPECT_TRUE(map_of(keyframes(kSetBackBy), kKept) == map_of(keyframes(kAsIfLater), kKept));
}

TEST(MapperTime, TheSettledMapDoesNotDependOnTheOrderOfArrival) {
  std::vector<KeyframeInput> inputs = keyframes(kSetBackBy);
  SemanticMapper in_order = make_mapper();
  for (const KeyframeInput& input : inputs) in_order.integrate(input);
  in_order.settle({});
  std::swap(inputs[kSetBack - 1], inputs[kSetBack]);
  SemanticMapper mixed = make_mapper();
  for (const KeyframeInput& input : inputs) mixed.integrate(input);
  mixed.settle({});
  EXPECT_TRUE(to_bytes(in_order.map().tree()) == to_bytes(mixed.map().tree()));
}

}  // namespace
}  // namespace rds::mapper
