// SPDX-License-Identifier: Apache-2.0
// Golden files: MOT15 detections and the output of the reference tracker (max_age 1, min_hits 3, IoU 0.3),
// one line per box: frame, id, left, top, width, height, … Tolerance 0.1 px; ids up to renaming.
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "services/tracker/core/prediction/sort/sort.hpp"
#include "tests/support/shared_data.hpp"

namespace rds::tracker::prediction {
namespace {

struct MotBox {
  int id = 0;
  geometry::Box2 box;
};
using Frames = std::map<int, std::vector<MotBox>>;

Frames read_mot(const std::filesystem::path& path) {
  std::ifstream file(path);
  Frames frames;
  for (std::string line; std::getline(file, line);) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream words(line);
    int frame = 0;
    MotBox row;
    double width = 0;
    double height = 0;
    if (!(words >> frame >> row.id >> row.box.x0 >> row.box.y0 >> width >> height)) continue;
    row.box.x1 = row.box.x0 + width;
    row.box.y1 = row.box.y0 + height;
    frames[frame].push_back(row);
  }
  return frames;
}

double largest_difference(const geometry::Box2& a, const geometry::Box2& b) {
  return std::max(
      {std::abs(a.x0 - b.x0), std::abs(a.y0 - b.y0), std::abs(a.x1 - b.x1), std::abs(a.y1 - b.y1)});
}

class SortReference : public ::testing::TestWithParam<const char*> {};

TEST_P(SortReference, IsReproducedBoxByBox) {
  RDS_REQUIRE_SHARED("data/sort");
  const auto folder = test::shared() / "data/sort" / GetParam();
  const Frames detections = read_mot(folder / "det.txt");
  Frames expected = read_mot(folder / "reference.txt");
  ASSERT_FALSE(detections.empty());
  ASSERT_FALSE(expected.empty());

  Sort sort({});
  std::map<int, std::uint64_t> our_id;    // by theirs
  std::map<std::uint64_t, int> their_id;  // by ours
  for (int frame = 1; frame <= detections.rbegin()->first; ++frame) {
    std::vector<geometry::Box2> boxes;
    if (const auto found = detections.find(frame); found != detections.end())
      for (const MotBox& row : found->second) boxes.push_back(row.box);
    sort.update(1, boxes);
    auto& theirs = expected[frame];
    for (const Sort::Track& track : sort.tracks()) {
      if (!sort.is_reported(track)) continue;
      const auto same = std::ranges::find_if(
          theirs, [&](const MotBox& row) { return largest_difference(row.box, track.filter.box()) <= 0.1; });
      ASSERT_NE(same, theirs.end()) << "frame " << frame << ": a box that the reference does not have";
      EXPECT_EQ(our_id.try_emplace(same->id, track.id).first->second, track.id) << "frame " << frame;
      EXPECT_EQ(their_id.try_emplace(track.id, same->id).first->second, same->id) << "frame " << frame;
      theirs.erase(same);
    }
    ASSERT_TRUE(theirs.empty()) << "frame " << frame << ": " << theirs.size()
                                << " boxes of the reference missing";
  }
}

INSTANTIATE_TEST_SUITE_P(Mot15, SortReference,
                         ::testing::Values("ETH-Sunnyday", "KITTI-17", "TUD-Campus", "TUD-Stadtmitte"),
                         [](const auto& sequence) {
                           std::string name = sequence.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace rds::tracker::prediction
