// SPDX-License-Identifier: Apache-2.0
#include "common/bus/participant.hpp"

#include <algorithm>
#include <atomic>

#include <gtest/gtest.h>

#include "common/bus/backend.hpp"
#include "common/messages/serialized.hpp"
#include "rmw_dds_common/msg/ParticipantEntitiesInfo.h"
#include "sensor_msgs/msg/Image.h"
#include "std_msgs/msg/Header.h"
#include "tests/unit/common/bus/bus_test_support.hpp"

namespace rds::bus {
namespace {

using rmw_dds_common::msg::ParticipantEntitiesInfo;
using std_msgs::msg::Header;

TEST(Vendor, HasANameThatReadsBack) {
  EXPECT_EQ(vendor_from_name("fastdds"), Vendor::kFastDds);
  EXPECT_EQ(vendor_from_name(name_of(Vendor::kCycloneDds)), Vendor::kCycloneDds);
  EXPECT_EQ(vendor_from_name("zenoh"), Vendor::kZenoh);
  EXPECT_THROW(vendor_from_name("opendds"), std::invalid_argument);
}

TEST(Vendor, OfDdsRefusesAnEndpointOfZenohAsPeer) {
  EXPECT_THROW(Participant::create({.node_name = "node", .loopback_only = true, .peers = {"tcp/robot:7447"}}),
               BusError);
}

class OneVendor : public ::testing::TestWithParam<Vendor> {};
class OneVendorOfDds : public OneVendor {};

TEST_P(OneVendor, RefusesADomainThatRtpsHasNoPortsFor) {
  EXPECT_THROW(join(GetParam(), "node", 233), BusError);
}

TEST_P(OneVendor, RefusesASecondTypeOnATopic) {
  auto participant = join(GetParam(), "node");
  auto publisher = participant->advertise<Header>("topic", kStream);
  EXPECT_THROW(participant->advertise<sensor_msgs::msg::Image>("topic", kStream), BusError);
}

TEST_P(OneVendor, CallbackHasEndedWhenTheSubscriptionIsGone) {
  auto participant = join(GetParam(), "node");
  auto other = join(GetParam(), "other");
  auto publisher = other->advertise<Header>("topic", kLatched);
  publisher.write(Header());
  std::atomic<bool> running = false;
  std::atomic<bool> finished = false;
  {
    auto subscription = participant->subscribe<Header>("topic", kLatched, [&](const auto&) {
      running = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      finished = true;
    });
    ASSERT_TRUE(eventually([&] { return running.load(); }));
  }
  EXPECT_TRUE(finished);
}

TEST_P(OneVendor, EndpointsOutliveTheirParticipantObject) {
  auto participant = join(GetParam(), "node");
  auto publisher = participant->advertise<Header>("topic", kStream);
  auto subscription = participant->subscribe<Header>("topic", kStream, [](const auto&) {});
  participant.reset();
  EXPECT_TRUE(publisher.write(Header()));
}

TEST_P(OneVendor, MessagesOutliveTheirSubscription) {
  auto writer_side = join(GetParam(), "writer");
  auto publisher = writer_side->advertise<Header>("topic", kLatched);
  Header header;
  header.frame_id("odom");
  publisher.write(header);
  Inbox<Header> inbox;
  {
    auto reader_side = join(GetParam(), "reader");
    auto subscription = reader_side->subscribe<Header>("topic", kLatched, inbox.callback());
    ASSERT_TRUE(eventually([&] { return inbox.size() == 1; }));
  }
  EXPECT_EQ(inbox.messages().front()->frame_id(), "odom");
}

std::size_t count_nonzero(const std::vector<rmw_dds_common::msg::Gid>& gids) {
  return static_cast<std::size_t>(std::count_if(gids.begin(), gids.end(), [](const auto& gid) {
    return std::any_of(gid.data().begin(), gid.data().end(), [](std::uint8_t byte) { return byte != 0; });
  }));
}

TEST_P(OneVendorOfDds, AnnouncesItsNodeWithItsEndpoints) {
  auto participant = join(GetParam(), "rds_tracker");
  auto publisher = participant->advertise<Header>("a", kStream);
  auto subscription = participant->subscribe<Header>("b", kStream, [](const auto&) {});
  // ros_discovery_info has no "rt/" prefix, so it takes a back end to listen to it.
  for (const Vendor listener : {Vendor::kFastDds, Vendor::kCycloneDds}) {
    const ParticipantOptions options{
        .vendor = listener, .domain = test_domain(), .node_name = "l", .loopback_only = true};
    auto backend = listener == Vendor::kFastDds ? detail::make_fastdds_backend(options)
                                                : detail::make_cyclonedds_backend(options);
    const TypeOps& type = type_ops<ParticipantEntitiesInfo>();
    auto reader = backend->make_reader("ros_discovery_info", type, kLatched);
    ParticipantEntitiesInfo info;
    EXPECT_TRUE(eventually([&] {
      detail::Sample sample{.type = &type, .message = &info};
      if (!reader->take(sample) || !sample.decoded) return false;
      const auto& nodes = info.node_entities_info_seq();
      return nodes.size() == 1 && nodes[0].node_name() == "rds_tracker" && nodes[0].node_namespace() == "/" &&
             count_nonzero(nodes[0].writer_gid_seq()) == 1 && count_nonzero(nodes[0].reader_gid_seq()) == 1;
    })) << name_of(listener);
  }
}

/// What a backend of `listener` hears on ros_discovery_info, as bytes, until `is_right`.
template <class Check>
bool hears_of_nodes(Vendor listener, Check is_right) {
  const ParticipantOptions options{
      .vendor = listener, .domain = test_domain(), .node_name = "l", .loopback_only = true};
  auto backend = listener == Vendor::kFastDds ? detail::make_fastdds_backend(options)
                                              : detail::make_cyclonedds_backend(options);
  static const TypeOps kBytes = [] {
    TypeOps type = messages::serialized(type_ops<ParticipantEntitiesInfo>());
    type.type_hash.clear();  // of whatever distribution
    return type;
  }();
  auto reader = backend->make_reader("ros_discovery_info", kBytes, kLatched);
  messages::SerializedMessage message;
  return eventually([&] {
    detail::Sample sample{.type = &kBytes, .message = &message};
    return reader->take(sample) && sample.decoded && is_right(message.bytes);
  });
}

/// The announcement of /robot1/node as ROS 2 writes it, with identifiers of `gid_size` bytes, which are zero
/// here.
std::vector<std::uint8_t> announcement_of_an_empty_node(std::size_t gid_size) {
  std::vector<std::uint8_t> bytes{0, 1, 0, 0};
  bytes.insert(bytes.end(), gid_size, 0);
  const std::vector<std::uint8_t> rest{1,   0,   0,   0, 8, 0, 0, 0, '/', 'r', 'o', 'b',
                                       'o', 't', '1', 0, 5, 0, 0, 0, 'n', 'o', 'd', 'e',
                                       0,   0,   0,   0, 0, 0, 0, 0, 0,   0,   0,   0};
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

TEST_P(OneVendorOfDds, AnnouncesItsNodeInTheFormOfTheDistribution) {
  for (const auto& [distro, gid_size] : {std::pair("humble", 24), std::pair("jazzy", 16)}) {
    const auto participant = Participant::create({.vendor = GetParam(),
                                                  .domain = test_domain(),
                                                  .node_name = "node",
                                                  .loopback_only = true,
                                                  .node_namespace = "robot1",
                                                  .ros_distro = ros_distro_from_name(distro)});
    const auto golden = announcement_of_an_empty_node(static_cast<std::size_t>(gid_size));
    EXPECT_TRUE(hears_of_nodes(Vendor::kCycloneDds, [&](std::vector<std::uint8_t> bytes) {
      if (bytes.size() < golden.size()) return false;
      const bool says_a_participant =
          std::any_of(bytes.begin() + 4, bytes.begin() + 20, [](auto b) { return b != 0; });
      std::fill_n(bytes.begin() + 4, 16, std::uint8_t{0});
      return says_a_participant && std::equal(golden.begin(), golden.end(), bytes.begin());
    })) << distro;
  }
}

TEST_P(OneVendor, TopicsStandBelowTheNamespaceAndAreRemapped) {
  const auto robot = Participant::create({.vendor = GetParam(),
                                          .domain = test_domain(),
                                          .node_name = "node",
                                          .loopback_only = true,
                                          .node_namespace = "robot1",
                                          .remappings = {{"in", "/out"}}});
  auto below = robot->advertise<Header>("a", kLatched);
  auto global = robot->advertise<Header>("/b", kLatched);
  auto remapped = robot->advertise<Header>("in", kLatched);
  for (auto* publisher : {&below, &global, &remapped}) publisher->write(Header());
  const auto other = join(GetParam(), "other");
  Inbox<Header> inbox;
  std::vector<Subscription> subscriptions;
  for (const char* topic : {"robot1/a", "b", "out"})
    subscriptions.push_back(other->subscribe<Header>(topic, kLatched, inbox.callback()));
  EXPECT_TRUE(eventually([&] { return inbox.size() == 3; }));
  EXPECT_EQ(robot->full_name("a"), "robot1/a");
  for (const EndpointStatistics& endpoint : robot->statistics())
    EXPECT_TRUE(endpoint.topic == "a" || endpoint.topic == "b" || endpoint.topic == "in") << endpoint.topic;
}

TEST_P(OneVendor, RefusesANamespaceThatRosWouldRefuse) {
  EXPECT_THROW(
      Participant::create(
          {.vendor = GetParam(), .domain = test_domain(), .node_name = "node", .node_namespace = "robot-1"}),
      BusError);
}

TEST_P(OneVendor, CountsWhatItCannotDecode) {
  auto participant = join(GetParam(), "node");
  auto other = join(GetParam(), "other");
  // A writer of the same type name whose bytes are an impossible string length.
  TypeOps hostile = type_ops<Header>();
  hostile.encoded_size = [](const void*) -> std::size_t { return 16; };
  hostile.encode = [](const void*, std::uint8_t* bytes, std::size_t) -> std::size_t {
    const std::uint8_t text[16] = {0, 1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 255, 255, 255, 255};
    std::copy(std::begin(text), std::end(text), bytes);
    return 16;
  };
  Inbox<Header> inbox;
  auto subscription = participant->subscribe<Header>("topic", kLatched, inbox.callback());
  auto publisher = other->make_publisher("topic", hostile, kLatched);
  const Header header;
  publisher->write(&header);
  EXPECT_TRUE(eventually([&] { return participant->statistics().at(0).dropped == 1; }));
  EXPECT_EQ(inbox.size(), 0U);
}

INSTANTIATE_TEST_SUITE_P(All, OneVendor, ::testing::ValuesIn(kAllVendors),
                         [](const auto& instance) { return name_of(instance.param); });
INSTANTIATE_TEST_SUITE_P(Both, OneVendorOfDds, ::testing::Values(Vendor::kFastDds, Vendor::kCycloneDds),
                         [](const auto& instance) { return name_of(instance.param); });

}  // namespace
}  // namespace rds::bus
