// SPDX-License-Identifier: Apache-2.0
// Somebody stands still for 10 s or two minutes: what is left of him in the map, with and without help of
// detector and tracker?
#include <gmock/gmock.h>

#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::SyntheticKeyframe;

constexpr std::uint64_t kStep = 3;      // keyframe ids are tenths of a second
constexpr std::uint64_t kArrives = 15;  // the wall is seen before he comes
constexpr std::uint64_t kLeaves = 115;  // 10 s later
constexpr double kPersonM = 1.5;
constexpr double kNothing = 0;

/// Who knows of the person in a keyframe.
struct Notice {
  const char* name;
  bool (*box)(std::uint64_t keyframe);
  bool (*cells)(std::uint64_t keyframe);
};

bool always(std::uint64_t) {
  return true;
}
bool never(std::uint64_t) {
  return false;
}
bool every_other(std::uint64_t keyframe) {
  return keyframe % 2 == 0;
}
bool the_others(std::uint64_t keyframe) {
  return keyframe % 2 == 1;
}
bool two_of_three(std::uint64_t keyframe) {
  return keyframe % 3 != 0;
}
bool now_and_then(std::uint64_t keyframe) {
  return keyframe * 2654435761U % 97 < 48;
}
bool first_half(std::uint64_t keyframe) {
  return keyframe * kStep < (kArrives + kLeaves) / 2;
}
bool second_half(std::uint64_t keyframe) {
  return !first_half(keyframe);
}

/// He sways by a few centimetres.
SyntheticKeyframe person_at(std::uint64_t keyframe, double background_m, const Notice& notice) {
  const double phase = 0.9 * static_cast<double>(keyframe);
  const cv::Rect body(120 + static_cast<int>(std::lround(6 * std::sin(phase))), 30, 80, 180);
  SyntheticKeyframe made(keyframe * kStep, background_m);
  made.rectangle(body, kPersonM + 0.03 * std::sin(0.7 * phase)).looked_for_objects();
  if (notice.box(keyframe)) made.box("person", body, true);
  if (notice.cells(keyframe)) made.movable_cells({body.x / 4 * 4, 28, 84, 184});
  return made;
}

class StandingPerson : public testing::TestWithParam<Notice> {
 protected:
  /// Voxels occupied before the background.
  [[nodiscard]] int left_over() const { return test::occupied_between(mapper_.map().tree(), 0.5, 2.5); }

  void stands_for_ten_seconds(double background_m) {
    for (std::uint64_t k = 0; k * kStep < kLeaves; ++k)
      mapper_.integrate(k * kStep < kArrives ? SyntheticKeyframe(k * kStep, background_m).looked_for_objects()
                                             : person_at(k, background_m, GetParam()));
  }
  void three_keyframes_without_him(double background_m) {
    for (std::uint64_t k = kLeaves / kStep + 1; k < kLeaves / kStep + 4; ++k)
      mapper_.integrate(SyntheticKeyframe(k * kStep, background_m).looked_for_objects());
  }

  SemanticMapper mapper_{MapperConfig{}};
};

/// Voxels that he fills for a mapper that nobody tells of people.
int voxels_of_person() {
  SemanticMapper mapper{MapperConfig{}};
  mapper.integrate(person_at(0, kNothing, {"", never, never}));
  return test::occupied_between(mapper.map().tree(), 0.5, 2.5);
}

TEST_P(StandingPerson, IsGoneThreeKeyframesAfterHeLeft) {
  stands_for_ten_seconds(3.0);
  three_keyframes_without_him(3.0);
  EXPECT_LE(left_over(), 0.01 * voxels_of_person());
  EXPECT_TRUE(test::is_occupied(mapper_.map().tree(), test::point_at(20, 120, 3.0)));
  mapper_.settle({});
  EXPECT_LE(left_over(), 0.01 * voxels_of_person());
  EXPECT_TRUE(test::is_occupied(mapper_.map().tree(), test::point_at(20, 120, 3.0)));
  EXPECT_TRUE(test::is_occupied(mapper_.map().tree(), test::point_at(160, 120, 3.0)));
}

/// Half of the keyframes or more know of him, by a box or by cells, all the time that he is there; else he
/// shows until he leaves.
class NoticedPerson : public StandingPerson {};

TEST_P(NoticedPerson, WhoSitsBeforeNothingMeasurableIsNeverOccupiedAtTheEnd) {
  stands_for_ten_seconds(kNothing);
  mapper_.settle({});
  EXPECT_EQ(left_over(), 0);
}

TEST_P(StandingPerson, WhoLeftAPlaceBeforeNothingMeasurableIsGone) {
  stands_for_ten_seconds(kNothing);
  three_keyframes_without_him(kNothing);
  EXPECT_EQ(left_over(), 0);
  mapper_.settle({});
  EXPECT_EQ(left_over(), 0);
}

/// Somebody whom a keyframe every one and a half seconds sees for two minutes.
class PersonForTwoMinutes : public StandingPerson {};

TEST_P(PersonForTwoMinutes, IsGoneThreeKeyframesAfterHeLeft) {
  constexpr std::uint64_t kSlow = 5;  // as many steps
  constexpr std::uint64_t kSeen = 1200 / (kSlow * kStep);
  const auto see = [&](std::uint64_t k, SyntheticKeyframe keyframe) {
    KeyframeInput input = keyframe;
    input.id = kSlow * kStep * k;
    input.stamp_ns = static_cast<std::int64_t>(input.id) * 100'000'000;
    mapper_.integrate(input);
  };
  const auto empty = [] { return SyntheticKeyframe(0).looked_for_objects(); };
  see(0, empty());
  for (std::uint64_t k = 1; k <= kSeen; ++k) see(k, person_at(k, 3.0, GetParam()));
  for (std::uint64_t k = kSeen + 1; k <= kSeen + 3; ++k) see(k, empty());
  EXPECT_LE(left_over(), 0.01 * voxels_of_person());
  mapper_.settle({});
  EXPECT_LE(left_over(), 0.01 * voxels_of_person());
}

std::string name_of(const testing::TestParamInfo<Notice>& tested) {
  return tested.param.name;
}

INSTANTIATE_TEST_SUITE_P(HalfTheTime, NoticedPerson,
                         testing::Values(Notice{"Boxes", always, never}, Notice{"CellsOnly", never, always},
                                         Notice{"EveryOtherBox", every_other, never},
                                         Notice{"TwoBoxesOfThree", two_of_three, never},
                                         Notice{"BoxesAndCellsInTurn", every_other, the_others},
                                         Notice{"BoxesNowAndThenAndCells", now_and_then, always}),
                         name_of);

INSTANTIATE_TEST_SUITE_P(HalfTheTime, PersonForTwoMinutes,
                         testing::Values(Notice{"EveryOtherBox", every_other, never},
                                         Notice{"TwoBoxesOfThree", two_of_three, never},
                                         Notice{"BoxesNowAndThen", now_and_then, never},
                                         Notice{"CellsNowAndThen", never, now_and_then}),
                         name_of);

INSTANTIATE_TEST_SUITE_P(
    Notices, StandingPerson,
    testing::Values(Notice{"Boxes", always, never}, Notice{"EveryOtherBox", every_other, never},
                    Notice{"BoxesNowAndThen", now_and_then, never}, Notice{"BoxesAtFirst", first_half, never},
                    Notice{"BoxesInTheEnd", second_half, never}, Notice{"CellsOnly", never, always},
                    Notice{"CellsNowAndThen", never, now_and_then},
                    Notice{"BoxesAndCellsInTurn", every_other, the_others},
                    Notice{"BoxesNowAndThenAndCells", now_and_then, always}),
    name_of);

}  // namespace
}  // namespace rds::mapper
