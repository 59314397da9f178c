// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/board/path_line.hpp"

#include <limits>

#include <gmock/gmock.h>

#include "tests/unit/services/viewer/frame_reader.hpp"

namespace rds::viewer {
namespace {

/// A page's path.
struct PagePath {
  std::vector<float> x;
  void apply(const Bytes& frame) {
    test::FrameReader in(frame);
    EXPECT_EQ(in.kind(), Kind::kPath);
    const auto first = in.get<std::uint32_t>();
    ASSERT_LE(first, x.size());
    x.resize(first);
    const auto count = in.get<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) {
      x.push_back(in.get<float>());
      in.get<float>();
      in.get<float>();
    }
    EXPECT_TRUE(in.at_end());
  }
};

TEST(PathLine, ClientsGetWhatTheyLack) {
  PathLine path;
  PathCursor cursor;
  PagePath page;
  EXPECT_FALSE(path.next(cursor)) << "an empty path is nothing new";
  for (int i = 0; i < 10; ++i) {
    path.add({static_cast<float>(i), 0, 0});
    if (i % 3 == 0) page.apply(path.next(cursor).value());
  }
  EXPECT_EQ(page.x.size(), 10U);
  EXPECT_FALSE(path.next(cursor));
  path.clear();
  page.apply(path.next(cursor).value());
  EXPECT_TRUE(page.x.empty());
}

TEST(PathLine, LeavesOutWhatIsNearAndWhatIsNoPoint) {
  PathLine path;
  path.add({0, 0, 0});
  path.add({0.005F, 0, 0});
  path.add({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  EXPECT_EQ(path.size(), 1U);
  path.add({0.02F, 0, 0});
  EXPECT_EQ(path.size(), 2U);
}

TEST(PathLine, AFullPathBecomesCoarserAndKeepsBothEnds) {
  PathLine path;
  PathCursor cursor;
  PagePath page;
  const std::size_t steps = 3 * PathLine::kMostPoints;
  for (std::size_t i = 0; i < steps; ++i) {
    path.add({static_cast<float>(i), 0, 0});
    EXPECT_LE(path.size(), PathLine::kMostPoints);
    if (i % 997 == 0) page.apply(path.next(cursor).value());
  }
  page.apply(path.next(cursor).value());
  EXPECT_EQ(page.x.size(), path.size());
  EXPECT_FLOAT_EQ(page.x.front(), 0);
  EXPECT_FLOAT_EQ(page.x.back(), static_cast<float>(steps - 1));
  EXPECT_TRUE(std::ranges::is_sorted(page.x));
}

}  // namespace
}  // namespace rds::viewer
