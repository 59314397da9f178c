// SPDX-License-Identifier: Apache-2.0
#include <sstream>

#include <gmock/gmock.h>
#include <octomap/OcTree.h>

#include "common/messages/detection_conversions.hpp"
#include "map_msgs/msg/OccupancyGridUpdate.h"
#include "tests/support/map_reader.hpp"
#include "tests/unit/services/mapper/mapper_on_the_bus.hpp"

namespace rds::mapper {
namespace {

using ::rds::test::MapReader;

/// That have come.
std::uint64_t full_maps(const bus::Participant& bus) {
  std::uint64_t count = 0;
  for (const auto& endpoint : bus.statistics())
    if (endpoint.topic == topics::kMapFull.name) count += endpoint.messages;
  return count;
}

TEST_F(MapperOnTheBus, GivesItsMapToWhoJoinsWhileNothingHappens) {
  start(config());
  for (std::uint64_t id = 0; id < 3; ++id) send(id);
  ASSERT_TRUE(has_revision(3));
  MapReader reader(*bus);
  ASSERT_TRUE(wait_for([&] { return reader.revision() == 3; }));
  EXPECT_EQ(full_maps(*bus), 1U);
  EXPECT_TRUE(reader.bytes() == saved_tree());
}

TEST_F(MapperOnTheBus, MakesFullMapsWhileSomebodyReadsThem) {
  auto often = config();
  often.full_map_every = 1;
  start(often);
  for (std::uint64_t id = 0; id < 3; ++id) send(id);
  ASSERT_TRUE(has_revision(3));
  MapReader reader(*bus);
  ASSERT_TRUE(wait_for([&] { return reader.revision() == 3; }));
  EXPECT_EQ(full_maps(*bus), 1U) << "the one for a new reader, none from before";
  send(3);
  EXPECT_TRUE(wait_for([&] { return full_maps(*bus) == 2U; }));
}

TEST_F(MapperOnTheBus, AReaderFollowsAMapperThatIsRestarted) {
  start(config());
  MapReader reader(*bus);
  for (std::uint64_t id = 0; id < 4; ++id) send(id);
  ASSERT_TRUE(wait_for([&] { return reader.revision() == 4; }));
  const std::uint64_t first = reader.map_id();
  start(config());  // takes the four keyframes that the bus keeps
  ASSERT_TRUE(wait_for([&] { return reader.map_id() != first && reader.revision() == 4; }));
  send(4);
  ASSERT_TRUE(wait_for([&] { return reader.revision() == 5; }));
  EXPECT_TRUE(reader.bytes() == saved_tree());
  ASSERT_TRUE(mapper->command("reset").success);
  ASSERT_TRUE(wait_for([&] { return reader.revision() == 0; }));
  EXPECT_TRUE(reader.bytes().empty());
}

TEST_F(MapperOnTheBus, WhilePausedTheOldestKeyframesAreDroppedAndCounted) {
  start(config());
  ASSERT_TRUE(mapper->command("pause").success);
  const auto figure = [&](const char* name) { return std::stoi(mapper->figure(name)); };
  for (int id = 0; id < 25; ++id) {
    send(static_cast<std::uint64_t>(id));
    ASSERT_TRUE(wait_for([&] { return figure("keyframes waiting") + figure("keyframes dropped") > id; }));
  }
  EXPECT_TRUE(wait_for([&] { return figure("keyframes dropped") == 5; }));
  EXPECT_EQ(figure("keyframes waiting"), 20);
  ASSERT_TRUE(mapper->command("resume").success);
  ASSERT_TRUE(has_revision(20));
  const std::lock_guard lock(mutex);
  EXPECT_EQ(info->keyframes_integrated(), 20U);
}

TEST_F(MapperOnTheBus, TellsLabelsThatColorsDoNotShow) {
  MapperServiceConfig by_picture = config();
  by_picture.expect_boxes = true;
  by_picture.mapper.octree.color_by_label = false;
  start(by_picture);
  const cv::Rect chair(100, 60, 90, 120);
  const KeyframeInput input = SyntheticKeyframe(0).rectangle(chair, 1.5).make();
  geometry::OrientedBox box;
  box.map_from_box.translation() = test::point_at(145, 120, 1.5);
  box.size = {0.5, 0.65, 0.2};
  const std::vector<messages::SpatialDetection> seen{{"chair", 0.9F, box, ""}};
  images.write(to_message(input));
  boxes.write(messages::to_detection_message(seen, messages::make_header(input.stamp_ns, "map")));
  ASSERT_TRUE(has_revision(1));
  MapReader late(*bus);
  ASSERT_TRUE(wait_for([&] { return late.revision() == 1; }));
  EXPECT_GT(late.labelled(), 50U);
}

TEST_F(MapperOnTheBus, PublishesBinaryMapAndPointsToWhoReadsThem) {
  start(config());
  send(0);
  ASSERT_TRUE(has_revision(1));
  std::shared_ptr<const octomap_msgs::msg::Octomap> binary;
  std::shared_ptr<const sensor_msgs::msg::PointCloud2> points;
  const auto binaries =
      bus->subscribe<octomap_msgs::msg::Octomap>("rds/map/binary", bus::kLatched, [&](const auto& m) {
        const std::lock_guard lock(mutex);
        binary = m;
      });
  const auto clouds =
      bus->subscribe<sensor_msgs::msg::PointCloud2>("rds/map/points", bus::kLatched, [&](const auto& m) {
        const std::lock_guard lock(mutex);
        points = m;
      });
  ASSERT_TRUE(wait_for([&] {
    const std::lock_guard lock(mutex);
    return binary && points;
  }));
  const std::lock_guard lock(mutex);
  EXPECT_EQ(binary->id(), "OcTree");
  EXPECT_TRUE(binary->binary());
  EXPECT_EQ(binary->header().frame_id(), "map");
  octomap::OcTree tree(binary->resolution());  // what octomap_msgs::binaryMsgToMap does
  std::stringstream data;
  data.write(binary->data().data() == nullptr ? "" : reinterpret_cast<const char*>(binary->data().data()),
             static_cast<std::streamsize>(binary->data().size()));
  tree.readBinaryData(data);
  tree.expand();
  std::size_t occupied = 0;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
    occupied += tree.isNodeOccupied(*leaf) ? 1U : 0U;
  EXPECT_GT(occupied, 500U);
  EXPECT_EQ(points->width(), occupied);
  EXPECT_EQ(points->height(), 1U);
  EXPECT_EQ(points->header().frame_id(), "map");
  EXPECT_EQ(messages::to_nanoseconds(points->header().stamp()),
            messages::to_nanoseconds(binary->header().stamp()));
  EXPECT_EQ(points->data().size(), std::size_t{points->row_step()});
  EXPECT_EQ(points->row_step(), points->width() * points->point_step());
  std::vector<std::string> names;
  for (const auto& field : points->fields()) {
    names.push_back(field.name());
    EXPECT_LE(field.offset() + 4, points->point_step());
  }
  EXPECT_THAT(names, testing::ElementsAre("x", "y", "z", "rgb", "label"));
}

TEST_F(MapperOnTheBus, ShowsChangesToWhoLooksAtTheGridWithinSeconds) {
  auto rare = config();
  rare.full_map_every = 1000;
  start(rare);
  std::vector<std::int64_t> stamps;
  const auto grids =
      bus->subscribe<nav_msgs::msg::OccupancyGrid>("rds/map/grid", bus::kLatched, [&](const auto& m) {
        const std::lock_guard lock(mutex);
        stamps.push_back(messages::to_nanoseconds(m->header().stamp()));
      });
  for (std::uint64_t id = 0; id < 3; ++id) {
    send(id);
    ASSERT_TRUE(has_revision(id + 1));
    ASSERT_TRUE(wait_for([&] {
      const std::lock_guard lock(mutex);
      return !stamps.empty() && stamps.back() >= SyntheticKeyframe(id).make().stamp_ns;
    })) << "keyframe "
        << id;
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  const std::lock_guard lock(mutex);
  EXPECT_LE(stamps.size(), 4U) << "one for each change, and the one for a new reader";
}

/// The grid of somebody who reads it whole once, and then what changes of it.
class GridFollower {
 public:
  explicit GridFollower(bus::Participant& bus)
      : wholes_(bus.subscribe<nav_msgs::msg::OccupancyGrid>("rds/map/grid", bus::kLatched,
                                                            [this](const auto& m) { take_whole(*m); })),
        updates_(bus.subscribe<map_msgs::msg::OccupancyGridUpdate>("rds/map/grid_updates", bus::kStream,
                                                                   [this](const auto& m) { take(*m); })) {}

  nav_msgs::msg::OccupancyGrid grid() {
    const std::lock_guard lock(mutex_);
    return grid_;
  }
  int updates() {
    const std::lock_guard lock(mutex_);
    return taken_;
  }
  /// Updates, and whole grids before them: as long as the mapper finds that a reader is new.
  int changes() {
    const std::lock_guard lock(mutex_);
    return changes_;
  }
  int wholes_after_updates() {
    const std::lock_guard lock(mutex_);
    return wholes_after_;
  }

 private:
  void take_whole(const nav_msgs::msg::OccupancyGrid& grid) {
    const std::lock_guard lock(mutex_);
    if (taken_ > 0) return void(++wholes_after_);
    grid_ = grid;
    ++changes_;
  }
  void take(const map_msgs::msg::OccupancyGridUpdate& update) {
    const std::lock_guard lock(mutex_);
    ++taken_;
    ++changes_;
    const auto row = [&](std::uint32_t y) {
      return (static_cast<std::size_t>(update.y()) + y) * grid_.info().width() +
             static_cast<std::size_t>(update.x());
    };
    for (std::uint32_t y = 0; y < update.height(); ++y)
      for (std::uint32_t x = 0; x < update.width(); ++x)
        grid_.data().at(row(y) + x) = update.data().at(std::size_t{y} * update.width() + x);
  }

  std::mutex mutex_;
  nav_msgs::msg::OccupancyGrid grid_;
  int taken_ = 0;
  int changes_ = 0;
  int wholes_after_ = 0;
  bus::Subscription wholes_;
  bus::Subscription updates_;
};

TEST_F(MapperOnTheBus, TellsWhatChangesOfTheGridToWhoFollowsIt) {
  auto rare = config();
  rare.full_map_every = 1000;
  rare.mapper.grid.up = "-y";  // neither depends on what is seen, so the grid stays where it is
  rare.mapper.grid.floor = "-1.2";
  start(rare);
  GridFollower follower(*bus);
  const auto show = [&](std::uint64_t id, const cv::Rect& px) {
    images.write(to_message(SyntheticKeyframe(id).rectangle(px, 2.0).make()));
    return has_revision(id + 1);
  };
  ASSERT_TRUE(show(0, {}));
  ASSERT_TRUE(wait_for([&] { return follower.grid().info().width() > 0; }));
  std::uint64_t id = 1;
  for (; id <= 3; ++id) {  // later ones would be outvoted by those that saw free space
    const int before = follower.changes();
    ASSERT_TRUE(show(id, {static_cast<int>(50 * id), 60, 40, 120}));
    ASSERT_TRUE(wait_for([&] { return follower.changes() > before; })) << "keyframe " << id;
  }
  EXPECT_GE(follower.updates(), 2);
  EXPECT_EQ(follower.wholes_after_updates(), 0);

  const auto elsewhere = join("late");
  nav_msgs::msg::OccupancyGrid whole;
  const auto late =
      elsewhere->subscribe<nav_msgs::msg::OccupancyGrid>("rds/map/grid", bus::kLatched, [&](const auto& m) {
        const std::lock_guard lock(mutex);
        whole = *m;
      });
  const auto is_of_the_follower = [&] {
    const std::lock_guard lock(mutex);
    return whole.data() == follower.grid().data() && whole.info().origin() == follower.grid().info().origin();
  };
  EXPECT_TRUE(wait_for(is_of_the_follower)) << "the newest whole grid, for who comes late";
  EXPECT_TRUE(wait_for([&] { return follower.wholes_after_updates() == 1; }));
  ASSERT_TRUE(show(id, {100, 60, 100, 120}));
  EXPECT_TRUE(wait_for([&] { return follower.wholes_after_updates() == 2; }))
      << "as somebody reads it who does not follow";
}

TEST_F(MapperOnTheBus, GoesOnInItsMapAfterARestart) {
  auto lasting = config();
  lasting.maps.checkpoint = true;
  lasting.maps.checkpoint_s = 0.1;
  start(lasting);
  for (const std::uint64_t end : {10U, 20U, 30U}) {  // more than the bus keeps
    for (std::uint64_t id = end - 10; id < end; ++id) send(id);
    ASSERT_TRUE(wait_for([&] {
      const std::lock_guard lock(mutex);
      return info && info->keyframes_integrated() == end;
    }));
  }
  mapper->command("finish");
  const auto before = saved_tree();
  start(lasting);
  EXPECT_TRUE(saved_tree() == before);
  send(30);
  ASSERT_TRUE(wait_for([&] {
    const std::lock_guard lock(mutex);
    return info->keyframes_integrated() == 31;
  }));
}

}  // namespace
}  // namespace rds::mapper
