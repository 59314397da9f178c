// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/grid/grid_update.hpp"

#include <random>

#include <gtest/gtest.h>

namespace rds::mapper {
namespace {

using nav_msgs::msg::OccupancyGrid;

OccupancyGrid grid(std::uint32_t width, std::uint32_t height) {
  OccupancyGrid grid;
  grid.header().frame_id("map");
  grid.info().resolution(0.05F);
  grid.info().width(width);
  grid.info().height(height);
  grid.data().assign(std::size_t{width} * height, -1);
  return grid;
}

/// As nav2_costmap_2d's static layer and RViz do it.
void apply(const map_msgs::msg::OccupancyGridUpdate& update, OccupancyGrid& grid) {
  std::size_t next = 0;
  for (std::uint32_t y = 0; y < update.height(); ++y)
    for (std::uint32_t x = 0; x < update.width(); ++x)
      grid.data().at((static_cast<std::uint32_t>(update.y()) + y) * grid.info().width() +
                     static_cast<std::uint32_t>(update.x()) + x) = update.data().at(next++);
  EXPECT_EQ(next, update.data().size());
}

TEST(GridUpdate, MakesTheNewestGridOfTheOneBefore) {
  std::mt19937 random(1);
  OccupancyGrid kept = grid(40, 25);
  OccupancyGrid newest = kept;
  for (int step = 0; step < 200; ++step) {
    for (std::uint32_t i = random() % 4; i > 0; --i)
      newest.data()[random() % newest.data().size()] = static_cast<std::int8_t>(random() % 101);
    const auto update = grid_update(kept, newest);
    ASSERT_TRUE(update);
    apply(*update, kept);
    ASSERT_EQ(kept.data(), newest.data()) << step;
  }
}

TEST(GridUpdate, IsTheSmallestRectangle) {
  const OccupancyGrid before = grid(40, 25);
  OccupancyGrid now = before;
  now.header().stamp().sec(7);
  now.data()[3 * 40 + 5] = 100;
  now.data()[6 * 40 + 2] = 0;
  const auto update = grid_update(before, now);
  ASSERT_TRUE(update);
  EXPECT_EQ(update->header(), now.header());
  EXPECT_EQ(update->x(), 2);
  EXPECT_EQ(update->y(), 3);
  EXPECT_EQ(update->width(), 4U);
  EXPECT_EQ(update->height(), 4U);
  EXPECT_EQ(grid_update(now, now)->width(), 0U);
}

TEST(GridUpdate, IsNoneOfAGridThatLiesElsewhere) {
  const OccupancyGrid before = grid(40, 25);
  EXPECT_FALSE(grid_update(before, grid(40, 26)));
  EXPECT_FALSE(grid_update(before, grid(25, 40)));
  OccupancyGrid moved = before;
  moved.info().origin().position().x(0.05);
  EXPECT_FALSE(grid_update(before, moved));
  OccupancyGrid finer = before;
  finer.info().resolution(0.025F);
  EXPECT_FALSE(grid_update(before, finer));
  OccupancyGrid framed = before;
  framed.header().frame_id("robot1/map");
  EXPECT_FALSE(grid_update(before, framed));
}

std::string guid(const std::string& process, int entity) {
  return process + ".02.03.04.05.06.07.08.09.0a.0b.0c.00.00.00.0" + std::to_string(entity);
}

TEST(GridReaders, AllReadUpdatesWhereNoProcessHasMoreOfTheGrid) {
  GridReaders readers{{guid("01", 1)}, {guid("01", 2)}};
  EXPECT_TRUE(readers.all_read_updates());
  readers.updates.insert(guid("03", 1));
  EXPECT_TRUE(readers.all_read_updates());
  readers.grid.insert(guid("02", 1));
  EXPECT_FALSE(readers.all_read_updates()) << "another process reads the grid alone";
  readers.grid = {guid("01", 1), guid("01", 3)};
  EXPECT_FALSE(readers.all_read_updates()) << "so does another node of one process";
}

TEST(GridReaders, AreNewWhereTheyWereNotThereBefore) {
  const GridReaders before{{guid("01", 1)}, {guid("01", 2)}};
  EXPECT_FALSE(before.has_new(before));
  EXPECT_FALSE(GridReaders().has_new(before));
  EXPECT_TRUE((GridReaders{{guid("02", 1)}, {guid("01", 2)}}.has_new(before)));
  EXPECT_TRUE((GridReaders{{guid("01", 1)}, {guid("01", 3)}}.has_new(before)));
}

}  // namespace
}  // namespace rds::mapper
