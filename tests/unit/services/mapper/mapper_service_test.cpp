// SPDX-License-Identifier: Apache-2.0
// The mapper on a bus of its own, beside somebody who plays tracker, transformer and reader.
#include "services/mapper/mapper_service.hpp"

#include <future>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <octomap/OcTree.h>
#include <unistd.h>

#include "common/messages/conversions.hpp"
#include "common/messages/detection_conversions.hpp"
#include "common/messages/image_conversions.hpp"
#include "services/mapper/core/map_files.hpp"
#include "services/mapper/core/tree_bytes.hpp"
#include "tests/support/map_reader.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using namespace std::chrono_literals;
using ::rds::test::MapReader;
using test::SyntheticKeyframe;
using Images = rds_msgs::msg::KeyFrameImages;
using Poses = rds_msgs::msg::KeyFramePoses;

constexpr std::uint64_t kEpoch = 42;

std::unique_ptr<bus::Participant> join(const std::string& name) {
  return bus::Participant::create({.vendor = bus::Vendor::kFastDds,
                                   .domain = 10 + static_cast<int>(getpid() % 200),
                                   .node_name = name,
                                   .loopback_only = true});
}

Images to_message(const KeyframeInput& input, std::uint64_t epoch = kEpoch) {
  const auto header = messages::make_header(input.stamp_ns, "camera_color_optical_frame");
  Images message;
  message.header(header);
  message.map_epoch(epoch);
  message.keyframe_id(input.id);
  message.map_from_camera(messages::to_pose_message(input.map_from_camera));
  message.camera_info(messages::to_camera_info(input.camera, header));
  message.color(messages::to_image_message(input.color, header));
  message.depth(messages::to_image_message(input.depth, header));
  return message;
}

template <class Condition>
bool wait_for(Condition condition) {
  const auto deadline = std::chrono::steady_clock::now() + 20s;
  while (!condition() && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(10ms);
  return condition();
}

/// A mapper process.
class RunningMapper {
 public:
  explicit RunningMapper(const MapperServiceConfig& config)
      : service_(context_, config), worker_([this](const std::stop_token& stop) { service_.run(stop); }) {}

  service::CommandOutcome command(const std::string& verb, const std::string& argument = "") {
    std::promise<service::CommandOutcome> outcome;
    service_.post({verb, argument, [&](const service::CommandOutcome& o) { outcome.set_value(o); }});
    return outcome.get_future().get();
  }
  [[nodiscard]] const service::Diagnostics& diagnostics() const { return diagnostics_; }
  std::uint64_t counter(const std::string& name) { return diagnostics_.counter(name); }
  [[nodiscard]] std::string figure(const std::string& name) const {
    for (const auto& [found, value] : diagnostics_.figures())
      if (found == name) return value;
    return "";
  }

 private:
  std::unique_ptr<bus::Participant> bus_ = join("mapper");
  service::Diagnostics diagnostics_;
  service::ServiceContext context_{"rds-mapper", *bus_, diagnostics_};
  MapperService service_;
  std::jthread worker_;
};

class MapperOnTheBus : public ::testing::Test {
 protected:
  static MapperServiceConfig config() {
    MapperServiceConfig config;
    config.expect_boxes = false;
    return config;
  }
  void start(const MapperServiceConfig& config) {
    mapper.reset();
    mapper = std::make_unique<RunningMapper>(config);
    ASSERT_TRUE(wait_for([&] { return images.matched() > 0 && boxes.matched() > 0 && poses.matched() > 0; }));
  }
  void send(std::uint64_t id) {
    images.write(to_message(SyntheticKeyframe(id, 2.5 + 0.1 * static_cast<double>(id)).make()));
  }
  bool has_revision(std::uint64_t revision) {
    return wait_for([&] {
      const std::lock_guard lock(mutex);
      return info && info->revision() >= revision;
    });
  }
  /// The mapper's own tree, from its file.
  std::vector<std::uint8_t> saved_tree() {
    const rds::test::TemporaryFolder place;
    EXPECT_TRUE(mapper->command("save", place.path().string()).success);
    return to_bytes(**read_tree(place / "map.ot"));
  }

  std::unique_ptr<bus::Participant> bus = join("others");
  bus::Publisher<Images> images = bus->advertise<Images>("rds/keyframe/images", bus::kKeyframeImages);
  bus::Publisher<Poses> poses = bus->advertise<Poses>("rds/keyframe/poses", bus::kLatched);
  bus::Publisher<vision_msgs::msg::Detection3DArray> boxes =
      bus->advertise<vision_msgs::msg::Detection3DArray>("rds/boxes", bus::kStream);
  std::mutex mutex;
  std::shared_ptr<const rds_msgs::msg::MapInfo> info;
  bus::Subscription infos =
      bus->subscribe<rds_msgs::msg::MapInfo>("rds/map/info", bus::kLatched, [this](const auto& m) {
        const std::lock_guard lock(mutex);
        info = m;
      });
  std::unique_ptr<RunningMapper> mapper;
};

TEST_F(MapperOnTheBus, GivesItsMapToWhoJoinsWhileNothingHappens) {
  start(config());
  for (std::uint64_t id = 0; id < 3; ++id) send(id);
  ASSERT_TRUE(has_revision(3));
  MapReader reader(*bus);
  ASSERT_TRUE(wait_for([&] { return reader.revision() == 3; }));
  EXPECT_EQ(reader.full_maps(), 1);
  EXPECT_TRUE(reader.bytes() == saved_tree());
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

TEST_F(MapperOnTheBus, BadInputIsDroppedAndCounted) {
  start(config());
  images.write(to_message(SyntheticKeyframe(0).make(), kEpoch - 1));
  ASSERT_TRUE(has_revision(1));
  send(1);  // another epoch
  ASSERT_TRUE(wait_for([&] {
    const std::lock_guard lock(mutex);
    return info->map_epoch() == kEpoch && info->revision() == 1;
  }));
  const auto rejects = [&](const Images& bad) {
    const std::uint64_t before = mapper->diagnostics().rejected();
    images.write(bad);
    return wait_for([&] { return mapper->diagnostics().rejected() == before + 1; });
  };
  EXPECT_TRUE(rejects(to_message(SyntheticKeyframe(2).make(), kEpoch - 1))) << "an epoch that is over";
  Images bad = to_message(SyntheticKeyframe(3).make());
  bad.map_from_camera().position().x(NAN);
  EXPECT_TRUE(rejects(bad));
  bad = to_message(SyntheticKeyframe(4).make());
  bad.depth().data().resize(10);
  EXPECT_TRUE(rejects(bad));
  bad = to_message(SyntheticKeyframe(5).make());
  bad.camera_info().k()[0] = -1;
  EXPECT_TRUE(rejects(bad));
  Poses strange;
  strange.map_epoch(kEpoch + 7);
  strange.keyframe_ids({1});
  strange.stamps({0});
  strange.poses({0, 0, 0, 0, 0, 0, 1});
  poses.write(strange);  // of an epoch without keyframes: it must not begin one
  Images blind = to_message(SyntheticKeyframe(6).rectangle({0, 0, 320, 240}, NAN).make());
  images.write(blind);
  ASSERT_TRUE(has_revision(2)) << "a keyframe without depth is one";
  {
    const std::lock_guard lock(mutex);
    EXPECT_EQ(info->map_epoch(), kEpoch);
    EXPECT_EQ(info->keyframes_integrated(), 2U);
  }
}

TEST_F(MapperOnTheBus, ImpossibleBoxesAreLeftOutAndCounted) {
  MapperServiceConfig with_boxes = config();
  with_boxes.expect_boxes = true;
  start(with_boxes);
  geometry::OrientedBox good;
  good.map_from_box.translation() = test::point_at(145, 120, 1.5);
  good.size = {0.5, 0.65, 0.2};
  geometry::OrientedBox huge = good;
  huge.size.x() = 1e30;
  geometry::OrientedBox flat = good;
  flat.size.z() = 0;
  geometry::OrientedBox beside = good;
  beside.map_from_box.translation() = Eigen::Vector3d(50, 0, 1.5);
  const std::vector<messages::SpatialDetection> seen{{"chair", 0.9F, good, ""}, {"chair", 0.9F, huge, ""},
                                                     {"chair", 0.9F, flat, ""}, {"chair", 0.9F, beside, ""},
                                                     {"", 0.9F, good, ""},      {"chair", 7.0F, good, ""}};
  const KeyframeInput input = SyntheticKeyframe(0).make();
  images.write(to_message(input));
  boxes.write(messages::to_detection_message(seen, messages::make_header(input.stamp_ns, "map")));
  ASSERT_TRUE(has_revision(1));
  EXPECT_EQ(mapper->counter("impossible boxes"), 5U);
  vision_msgs::msg::Detection3DArray nonsense =
      messages::to_detection_message(seen, messages::make_header(input.stamp_ns, "map"));
  nonsense.detections()[0].bbox().size().x(-1);
  boxes.write(nonsense);
  EXPECT_TRUE(wait_for([&] { return mapper->diagnostics().rejected() == 1; }));
}

}  // namespace
}  // namespace rds::mapper
