// SPDX-License-Identifier: Apache-2.0
// Readers that keep a copy of the map: beside the mapper, and as if they were on another machine.
#include "services/mapper/reader/map_follower.hpp"

#include <csignal>

#include <gtest/gtest.h>

#include "tests/support/process.hpp"
#include "tests/unit/services/mapper/mapper_on_the_bus.hpp"

namespace rds::mapper {
namespace {

constexpr std::uint64_t kElsewhere = 1;  // a machine

/// A process that follows the map.
struct Reader {
  Reader(bus::Vendor vendor, std::uint64_t host)
      : bus(bus::Participant::create({.vendor = vendor,
                                      .domain = rds::test::test_domain(),
                                      .node_name = "reader",
                                      .loopback_only = true})),
        follower(context, host) {}

  bool has(std::uint64_t revision) {
    return wait_for([&] { return follower.map().place().revision == revision; });
  }
  std::vector<std::uint8_t> bytes() const {
    std::vector<std::uint8_t> bytes;
    follower.map().look([&](const OctreeReplica& replica, const auto&) { bytes = to_bytes(replica.tree()); });
    return bytes;
  }

  std::unique_ptr<bus::Participant> bus;
  service::Diagnostics diagnostics;
  service::ServiceContext context{"reader", *bus, diagnostics};
  MapFollower follower;
};

class MapFollowerOnTheBus : public MapperOnTheBus {
 protected:
  void send_until(std::uint64_t revision) {
    while (sent_ < revision) send(sent_++);
    ASSERT_TRUE(has_revision(revision));
  }
  std::uint64_t sent_ = 0;  // keyframes, each of which is a revision
};

TEST_F(MapFollowerOnTheBus, HasTheMappersTreeFromAnotherMachine) {
  start(config());
  send_until(3);
  Reader fast(bus::Vendor::kFastDds, kElsewhere);
  Reader cyclone(bus::Vendor::kCycloneDds, kElsewhere);
  for (std::uint64_t revision = 3; revision < 8; ++revision) {
    send_until(revision);
    if (revision == 5) continue;  // two steps at once
    for (Reader* reader : {&fast, &cyclone}) ASSERT_TRUE(reader->has(revision)) << revision;
  }
  EXPECT_EQ(fast.follower.where(), MapFollower::Where::kElsewhere);
  const auto expected = saved_tree();
  for (const Reader* reader : {&fast, &cyclone}) {
    EXPECT_TRUE(reader->bytes() == expected);
    EXPECT_EQ(reader->diagnostics.rejected(), 0U);
  }
}

TEST_F(MapFollowerOnTheBus, TakesTheTopicsBesideTheMapper) {
  start(config());
  send_until(3);
  Reader reader(bus::Vendor::kFastDds, transfer::this_host());
  ASSERT_TRUE(reader.has(3));
  send_until(5);
  ASSERT_TRUE(reader.has(5));
  EXPECT_EQ(reader.follower.where(), MapFollower::Where::kHere);
  EXPECT_TRUE(reader.bytes() == saved_tree());
  EXPECT_EQ(mapper->counter("map updates made"), 0U);
}

TEST_F(MapFollowerOnTheBus, GoesOverToTheMapThatAMapperBegins) {
  start(config());
  send_until(4);
  Reader reader(bus::Vendor::kFastDds, kElsewhere);
  ASSERT_TRUE(reader.has(4)) << reader.follower.map().place().revision;
  const std::uint64_t first = reader.follower.map().place().map_id;
  ASSERT_TRUE(mapper->command("reset").success);
  send(4);
  send(5);
  ASSERT_TRUE(wait_for([&] { return reader.follower.map().place().map_id != first; }));
  ASSERT_TRUE(reader.has(2)) << "of the new map";
  EXPECT_TRUE(reader.bytes() == saved_tree());
}

/// The mapper's process, killed and started again.
TEST_F(MapFollowerOnTheBus, GoesOverToAnotherProcess) {
  const std::string settings = (maps / "mapper.yaml").string();
  rds::test::write_text(settings, "expect_boxes: false\ncheckpoint: false\n");
  const std::vector<std::string> command{RDS_BIN_DIR "/rds-mapper", "--loopback", "--domain",
                                         std::to_string(rds::test::test_domain()), "--config", settings};
  Reader reader(bus::Vendor::kCycloneDds, kElsewhere);
  auto process = std::make_unique<rds::test::Process>(command);
  ASSERT_TRUE(wait_for([&] { return images.matched() > 0; })) << process->standard_error();
  for (std::uint64_t id = 0; id < 4; ++id) send(id);
  ASSERT_TRUE(reader.has(4)) << process->standard_error();
  const std::uint64_t first = reader.follower.map().place().map_id;
  process->kill();
  process = std::make_unique<rds::test::Process>(command);  // takes the keyframes that the bus keeps
  ASSERT_TRUE(wait_for([&] { return reader.follower.map().place().map_id != first; }));
  ASSERT_TRUE(reader.has(4)) << reader.follower.map().place().revision;
}

}  // namespace
}  // namespace rds::mapper
