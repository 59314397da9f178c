// SPDX-License-Identifier: Apache-2.0
// The tools' readers against a publisher in this process, on both vendors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nav_msgs/msg/Odometry.h"
#include "octomap_msgs/msg/Octomap.h"
#include "rds_msgs/msg/MapInfo.h"
#include "services/mapper/io/map_files.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_domain.hpp"
#include "tools/rds/map/live_map.hpp"
#include "tools/rds/cli/commands.hpp"
#include "tools/rds/topic/topic_reader.hpp"

namespace rds::tools {
namespace {
using nav_msgs::msg::Odometry;
using testing::HasSubstr;

const int kDomain = test::test_domain();

class LiveBus : public testing::TestWithParam<bus::Vendor> {
 protected:
  static std::unique_ptr<bus::Participant> join(const std::string& name, bus::Vendor vendor) {
    return bus::Participant::create(
        {.vendor = vendor, .domain = kDomain, .node_name = name, .loopback_only = true});
  }
  static Clock::time_point in(std::chrono::seconds time) { return Clock::now() + time; }

  std::unique_ptr<bus::Participant> publishing = join("publisher", GetParam());
  std::unique_ptr<bus::Participant> reading = join("reader", bus::Vendor::kFastDds);
  std::stop_source stop;
};

TEST_P(LiveBus, ReadsALatchedTopicOfUnknownType) {
  auto publisher = publishing->advertise<Odometry>("t/odometry", bus::kLatched);
  Odometry sent;
  sent.child_frame_id("camera");
  publisher.write(sent);
  const auto reader =
      TopicReader::open(*reading, "t/odometry", true, in(std::chrono::seconds(20)), stop.get_token());
  ASSERT_TRUE(reader) << reader.error();
  const auto arrival = (*reader)->next(in(std::chrono::seconds(20)), stop.get_token());
  ASSERT_TRUE(arrival);
  EXPECT_EQ((*reader)->type().to_json(arrival->message.get()).at("child_frame_id"), "camera");
  EXPECT_GT(arrival->bytes, 700U);
}

TEST_P(LiveBus, ReadsABestEffortTopic) {
  auto publisher = publishing->advertise<Odometry>("t/sensor", bus::kSensorBestEffort);
  const auto reader =
      TopicReader::open(*reading, "t/sensor", false, in(std::chrono::seconds(20)), stop.get_token());
  ASSERT_TRUE(reader) << reader.error();
  std::optional<Arrival> arrival;
  for (int i = 0; i < 200 && !arrival; ++i) {
    publisher.write(Odometry());
    arrival = (*reader)->next(Clock::now() + std::chrono::milliseconds(50), stop.get_token());
  }
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->message, nullptr);
}

/// A map on the bus, of one voxel and revision 7.
class LiveBusMap : public LiveBus {
 protected:
  LiveBusMap() {
    tree.setNodeValue(1.05, 0.05, 0.05, 0.85F);
    tree.updateInnerOccupancy();
    const auto bytes = mapper::to_bytes(tree);
    octomap_msgs::msg::Octomap full;
    full.id("ColorOcTree");
    full.resolution(0.1);
    full.data().assign(bytes.begin(), bytes.end());
    rds_msgs::msg::MapInfo info;
    info.revision(7);
    info.labels({"", "chair"});
    full_publisher_.write(full);
    info_publisher_.write(info);
  }
  octomap::ColorOcTree tree{0.1};

 private:
  bus::Publisher<octomap_msgs::msg::Octomap> full_publisher_ =
      publishing->advertise<octomap_msgs::msg::Octomap>("rds/map/full", bus::kLatched);
  bus::Publisher<rds_msgs::msg::MapInfo> info_publisher_ =
      publishing->advertise<rds_msgs::msg::MapInfo>("rds/map/info", bus::kLatched);
};

TEST_P(LiveBusMap, IsTaken) {
  const auto map = take_live_map(*reading, std::chrono::seconds(20), stop.get_token());
  ASSERT_TRUE(map) << map.error();
  EXPECT_TRUE(*map->tree == tree);
  EXPECT_EQ(map->revision, 7U);
  EXPECT_EQ(map->labels.size(), 2U);
}

TEST_P(LiveBusMap, IsComparedWithASavedOne) {
  const test::TemporaryFolder folder;
  const std::string file = (folder / "map.ot").string();
  const auto status = [&] {
    CLI::App rds;
    add_map_command(rds);
    const std::string domain = std::to_string(kDomain);
    try {
      rds.parse(std::vector<std::string>{"--loopback", domain, "--domain", file, "diff", "map"});
    } catch (const CLI::RuntimeError& e) {
      return e.get_exit_code();
    }
    return 0;
  };
  ASSERT_TRUE(mapper::write_tree(file, tree));
  EXPECT_EQ(status(), 0);
  tree.setNodeValue(2.05, 0.05, 0.05, 0.85F);
  tree.updateInnerOccupancy();
  ASSERT_TRUE(mapper::write_tree(file, tree));
  EXPECT_EQ(status(), 1);
}

TEST_P(LiveBus, SaysThatNobodyPublishes) {
  const auto reader = TopicReader::open(*reading, "t/none", true, Clock::now(), stop.get_token());
  EXPECT_THAT(reader.error(), HasSubstr("t/none: nobody publishes it"));
  stop.request_stop();
  EXPECT_THAT(take_live_map(*reading, std::chrono::hours(1), stop.get_token()).error(), HasSubstr("no map"));
}

const auto kVendors = testing::Values(bus::Vendor::kFastDds, bus::Vendor::kCycloneDds);
const auto kName = [](const auto& test_case) { return bus::name_of(test_case.param); };
INSTANTIATE_TEST_SUITE_P(Vendors, LiveBus, kVendors, kName);
INSTANTIATE_TEST_SUITE_P(Vendors, LiveBusMap, kVendors, kName);

}  // namespace
}  // namespace rds::tools
