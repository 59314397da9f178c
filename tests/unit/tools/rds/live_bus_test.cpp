// SPDX-License-Identifier: Apache-2.0
// The tools' readers against a publisher in this process, on each bus.
#include <algorithm>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "nav_msgs/msg/Odometry.h"
#include "octomap_msgs/msg/Octomap.h"
#include "rds_msgs/msg/MapInfo.h"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "services/mapper/io/map_files.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_domain.hpp"
#include "tools/rds/cli/commands.hpp"
#include "tools/rds/map/live_map.hpp"
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

  /// Of a subcommand on this bus.
  [[nodiscard]] int status_of(void (*add_command)(CLI::App&), std::vector<std::string> words) const {
    CLI::App rds;
    add_command(rds);
    words.insert(words.end(),
                 {"--bus", bus::name_of(readers_vendor), "--domain", std::to_string(kDomain), "--loopback"});
    std::ranges::reverse(words);  // as CLI11 wants them
    try {
      rds.parse(words);
    } catch (const CLI::RuntimeError& e) {
      return e.get_exit_code();
    }
    return 0;
  }

  /// Both vendors of DDS are read by one of them.
  const bus::Vendor readers_vendor = GetParam() == bus::Vendor::kZenoh ? GetParam() : bus::Vendor::kFastDds;
  std::unique_ptr<bus::Participant> publishing = join("publisher", GetParam());
  std::unique_ptr<bus::Participant> reading = join("reader", readers_vendor);
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

TEST_P(LiveBus, IsToldByTheCommandsOfTopics) {
  auto publisher = publishing->advertise<Odometry>("t/odometry", bus::kStream);
  const std::jthread odometry([&](const std::stop_token& ended) {
    for (; !ended.stop_requested(); std::this_thread::sleep_for(std::chrono::milliseconds(10)))
      publisher.write(Odometry());
  });
  const auto told_by = [&](const std::string& command, const std::vector<std::string>& words) {
    std::vector<std::string> all{"topic", command};
    all.insert(all.end(), words.begin(), words.end());
    testing::internal::CaptureStdout();
    EXPECT_EQ(status_of(add_topic_command, all), 0) << command;
    return testing::internal::GetCapturedStdout();
  };
  EXPECT_THAT(told_by("hz", {"t/odometry", "--seconds", "0.3"}), HasSubstr("Hz"));
  EXPECT_THAT(told_by("bw", {"/t/odometry", "--seconds", "0.3"}), HasSubstr("B/s"));
  EXPECT_THAT(told_by("echo", {"t/odometry", "--count", "1"}), HasSubstr("child_frame_id"));
  const auto listed = nlohmann::json::parse(told_by("list", {"--timeout", "1", "--json"}));
  EXPECT_THAT(listed, testing::Contains(nlohmann::json{{"topic", "t/odometry"},
                                                       {"type", "nav_msgs/msg/Odometry"},
                                                       {"publishers", 1},
                                                       {"subscribers", 0}}));
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
  const auto status = [&] { return status_of(add_map_command, {"map", "diff", file}); };
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

INSTANTIATE_TEST_SUITE_P(Vendors, LiveBus, testing::ValuesIn(test::kAllVendors), test::vendor_name);
INSTANTIATE_TEST_SUITE_P(Vendors, LiveBusMap, testing::ValuesIn(test::kAllVendors), test::vendor_name);

}  // namespace
}  // namespace rds::tools
