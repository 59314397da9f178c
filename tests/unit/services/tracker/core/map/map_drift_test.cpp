// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/map_drift.hpp"

#include <gtest/gtest.h>

#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

constexpr double kOwnVariance = 1e-6;  // of each keyframe's pose in what it sees

/// Keyframes in a row; each brings two points of its own.
class MapDriftTest : public ::testing::Test {
 protected:
  static Pose place(KeyframeId k) { return test::pose(0.5 * static_cast<double>(k), 0, 0, 0); }

  /// A keyframe that sees these points. @return its own points.
  std::vector<PointId> add_keyframe(const std::vector<PointId>& seen) {
    std::mt19937 random(1);
    const KeyframeId next = map.records().next_id();
    const auto view = test::view_of(test::random_points(50, random), Pose::Identity(), 0, random);
    const KeyframeId id = map.add_keyframe(1000, place(next), view.features).id;
    if (id > 0) drift.add(id, drift.under(map, seen, place(id)) + kOwnVariance * Matrix6::Identity());
    std::vector<PointId> own;
    for (std::uint32_t f = 0; f < 2; ++f) own.push_back(map.add_point({0, 0, 3}, id, f).id);
    return own;
  }

  SlamMap map{ScalePyramid(8, 1.2)};
  MapDrift drift;
};

TEST_F(MapDriftTest, TheFirstKeyframesPointsAreCertain) {
  const auto first = add_keyframe({});
  EXPECT_EQ(drift.under(map, first, place(0)), Matrix6::Zero());
  EXPECT_EQ(drift.under(map, {}, place(0)), Matrix6::Zero()) << "nothing is seen";
}

TEST_F(MapDriftTest, GrowsWithTheWayAndFallsWhereTheCameraComesBack) {
  const auto first = add_keyframe({});
  auto last = first;
  double before = 0;
  for (int k = 1; k < 10; ++k) {
    last = add_keyframe(last);
    const double now = drift.under(map, last, place(k))(3, 3);
    EXPECT_NEAR(now, before + kOwnVariance, 1e-12) << k << ": each step adds its own error";
    before = now;
  }
  EXPECT_EQ(drift.under(map, first, place(9)), Matrix6::Zero());
  EXPECT_NEAR(drift.under(map, std::vector{first[0], last[0], kNoId, PointId{9999}}, place(9))(3, 3),
              before / 2, 1e-12)
      << "half of the points are those of the origin";
}

TEST_F(MapDriftTest, ATurnOfTheMapMovesACameraThatIsFarFromWhereItBegan) {
  const auto first = add_keyframe({});
  const auto second = add_keyframe(first);
  const Pose far = place(1) * test::pose(0, 0, 4, 0);
  const Matrix6 here = drift.under(map, second, place(1));
  const Matrix6 there = drift.under(map, second, far);
  EXPECT_NEAR(there(3, 3), here(3, 3), 1e-12);
  EXPECT_NEAR(there(0, 0), kOwnVariance * (1 + 4 * 4), 1e-12) << "σ² of its place and of a turn, 4 m away";
}

TEST_F(MapDriftTest, KeyframesThatItDoesNotKnowAreExact) {
  const auto second = add_keyframe(add_keyframe({}));
  drift.forget();
  EXPECT_EQ(drift.under(map, second, place(1)), Matrix6::Zero());
}

}  // namespace
}  // namespace rds::tracker
