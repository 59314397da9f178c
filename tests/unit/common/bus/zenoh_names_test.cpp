// SPDX-License-Identifier: Apache-2.0
// What rmw_zenoh writes on the network, and what anybody may write there.
#include "common/bus/zenoh/wire/zenoh_names.hpp"

#include <random>

#include <gtest/gtest.h>

#include "common/bus/zenoh/wire/zenoh_attachment.hpp"
#include "common/bus/zenoh/zenoh_graph.hpp"

namespace rds::bus::detail {
namespace {

// rmw_zenoh's docs/design.md
const std::string kHash = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18";
const std::string kSession = "8b20917502ee955ac4476e0266340d5c";
const std::string kToken = "@ros2_lv/2/" + kSession +
                           "/0/10/MP/%/%/talker/%chatter/std_msgs::msg::dds_::String_/" + kHash +
                           "/::,7:,:,:,,";
const ZenohNodeName kTalker{2, kSession, "talker"};

TypeOps string_type() {
  TypeOps type{};
  type.dds_name = "std_msgs::msg::dds_::String_";
  type.type_hash = kHash;
  return type;
}

TEST(ZenohNames, AreThoseOfRmwZenoh) {
  EXPECT_EQ(topic_key(2, "chatter", string_type()), "2/chatter/std_msgs::msg::dds_::String_/" + kHash);
  EXPECT_EQ(node_token(kTalker), "@ros2_lv/2/" + kSession + "/0/0/NN/%/%/talker");
  EXPECT_EQ(endpoint_token(kTalker, 10, "chatter", string_type(), {.depth = 7}, true), kToken);
  EXPECT_EQ(node_token({2, kSession, "talker", "/robot1/arm"}),
            "@ros2_lv/2/" + kSession + "/0/0/NN/%/%robot1%arm/talker");
}

TEST(ZenohNames, SayTheQos) {
  const auto qos_of = [](const Qos& qos) {
    const std::string token = endpoint_token(kTalker, 1, "a/b", string_type(), qos, false);
    return token.substr(token.rfind('/') + 1);
  };
  EXPECT_EQ(qos_of(kStream), "::,10:,:,:,,");
  EXPECT_EQ(qos_of(kLatched), ":1:,1:,:,:,,");
  EXPECT_EQ(qos_of(kSensorBestEffort), "2::,5:,:,:,,");
  EXPECT_EQ(qos_of({.depth = 42}), "::,:,:,:,,");
}

TEST(ZenohNames, ReadBack) {
  const std::string token = endpoint_token(kTalker, 3, "a/b", string_type(), kLatched, false);
  const auto read = parse_endpoint_token(token);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->endpoint.topic, "a/b");
  EXPECT_EQ(read->endpoint.type, "std_msgs::msg::dds_::String_");
  EXPECT_EQ(read->endpoint.type_hash, kHash);
  EXPECT_FALSE(read->endpoint.publisher);
  EXPECT_TRUE(read->endpoint.reliable);
  EXPECT_TRUE(read->endpoint.transient_local);
  EXPECT_EQ(read->session, session_guid(kSession));
}

TEST(ZenohNames, OfNodesAndServicesAreNoEndpoints) {
  EXPECT_FALSE(parse_endpoint_token(node_token(kTalker)));
  std::string service = kToken;
  service.replace(service.find("/MP/"), 4, "/SS/");
  EXPECT_FALSE(parse_endpoint_token(service));
}

// rmw_zenoh's docs/design.md
TEST(ZenohNames, OfServicesAreThoseOfRmwZenoh) {
  const std::string hash = "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a";
  TypeOps request{};
  request.dds_name = "example_interfaces::srv::dds_::AddTwoInts_Request_";
  const ServiceType type{request, request, hash.c_str()};
  EXPECT_EQ(service_key(2, "add_two_ints", type),
            "2/add_two_ints/example_interfaces::srv::dds_::AddTwoInts_/" + hash);
  const ZenohNodeName node{2, "f9980ee0495eaafb3e38f0d19e2eae12", "add_two_ints_server"};
  const std::string server = service_token(node, 10, "add_two_ints", type, true);
  EXPECT_EQ(server,
            "@ros2_lv/2/f9980ee0495eaafb3e38f0d19e2eae12/0/10/SS/%/%/add_two_ints_server/%add_two_ints/"
            "example_interfaces::srv::dds_::AddTwoInts_/" +
                hash + "/::,10:,:,:,,");
  EXPECT_FALSE(is_client_token(server));
  EXPECT_TRUE(is_client_token(service_token(node, 10, "add_two_ints", type, false)));
}

TEST(ZenohGraph, KnowsWhoAskedAndHasLeft) {
  ZenohGraph graph(*session_guid("1"));
  std::string client = kToken;
  client.replace(client.find("/MP/"), 4, "/SC/");
  const Guid gid = gid_of_token(client);
  EXPECT_FALSE(graph.has_left(gid)) << "never announced";
  graph.take(client, true);
  EXPECT_FALSE(graph.has_left(gid));
  graph.take(client, false);
  EXPECT_TRUE(graph.has_left(gid));
  EXPECT_TRUE(graph.discovered().empty());
}

TEST(ZenohNames, ATopicIsNoPattern) {
  EXPECT_THROW(topic_key(0, "*", string_type()), BusError);
  EXPECT_THROW(topic_key(0, "", string_type()), BusError);
}

TEST(ZenohNames, ASessionIsHexadecimal) {
  const auto guid = session_guid("abc");
  ASSERT_TRUE(guid);
  EXPECT_EQ((*guid)[14], 0x0a);
  EXPECT_EQ((*guid)[15], 0xbc);
  EXPECT_FALSE(session_guid(""));
  EXPECT_FALSE(session_guid("g"));
  EXPECT_FALSE(session_guid(std::string(33, '0')));
}

/// XXH3's published vector for no bytes without seed: 99aa06d3014798d8 (high), 6001c324468d497f (low).
TEST(ZenohNames, AGidIsXxh3WithTheLowHalfFirst) {
  const Guid expected{0x7f, 0x49, 0x8d, 0x46, 0x24, 0xc3, 0x01, 0x60,
                      0xd8, 0x98, 0x47, 0x01, 0xd3, 0x06, 0xaa, 0x99};
  EXPECT_EQ(gid_of_token(""), expected);
}

TEST(ZenohAttachment, ReadsBack) {
  const ZenohAttachment attachment{1, 1'700'000'000'123'456'789, gid_of_token(kToken)};
  const auto bytes = to_bytes(attachment);
  EXPECT_EQ(bytes[0], 1);
  EXPECT_EQ(bytes[16], 16);
  const auto read = parse_attachment(bytes);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->sequence, attachment.sequence);
  EXPECT_EQ(read->stamp_ns, attachment.stamp_ns);
  EXPECT_EQ(read->gid, attachment.gid);
  EXPECT_FALSE(parse_attachment(std::span(bytes).first(32)));
}

TEST(SequenceGaps, CountsWhatIsMissingOfEachWriter) {
  SequenceGaps gaps;
  const Guid one = gid_of_token("1");
  const Guid two = gid_of_token("2");
  EXPECT_EQ(gaps.count({5, 0, one}), 0U);  // joined late
  EXPECT_EQ(gaps.count({6, 0, one}), 0U);
  EXPECT_EQ(gaps.count({1, 0, two}), 0U);
  EXPECT_EQ(gaps.count({9, 0, one}), 2U);
  EXPECT_EQ(gaps.count({8, 0, one}), 0U);
  EXPECT_EQ(gaps.count({10, 0, one}), 0U);
}

TEST(ZenohGraph, KnowsWhoIsThere) {
  ZenohGraph graph(*session_guid("1"));
  graph.take(kToken, true);
  ASSERT_EQ(graph.discovered().size(), 1U);
  EXPECT_EQ(graph.matched("chatter", "std_msgs::msg::dds_::String_", false), 1);
  EXPECT_EQ(graph.matched("chatter", "std_msgs::msg::dds_::String_", true), 0);
  EXPECT_EQ(graph.session_of(gid_of_token(kToken)), session_guid(kSession));
  graph.take(kToken, false);
  EXPECT_TRUE(graph.discovered().empty());
}

TEST(ZenohGraph, BelievesNobodyWhoSpeaksInItsName) {
  ZenohGraph graph(*session_guid(kSession));
  graph.take(kToken, true);
  EXPECT_TRUE(graph.discovered().empty());
}

// Hostile input: whatever is read is whole, and the rest is refused.
constexpr int kMutations = 10'000;

/// Changes, inserts or removes up to four bytes.
template <class Bytes>
Bytes mutated(Bytes bytes, std::mt19937& random) {
  const auto below = [&](std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
  };
  for (std::size_t count = 1 + below(4); count > 0 && !bytes.empty(); --count) {
    const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(below(bytes.size()));
    const auto byte = static_cast<typename Bytes::value_type>(below(256));
    switch (below(3)) {
      case 0:
        *at = byte;
        break;
      case 1:
        bytes.insert(at, byte);
        break;
      default:
        bytes.erase(at,
                    at + static_cast<std::ptrdiff_t>(1 + below(static_cast<std::size_t>(bytes.end() - at))));
    }
  }
  return bytes;
}

TEST(ZenohHostile, TokensAreReadWholeOrNot) {
  std::mt19937 random(1);
  ZenohGraph graph(*session_guid("1"));
  int refused = 0;
  for (int i = 0; i < kMutations; ++i) {
    const std::string token = mutated(kToken, random);
    const auto read = parse_endpoint_token(token);
    graph.take(token, true);
    if (!read) {
      ++refused;
      continue;
    }
    EXPECT_FALSE(read->endpoint.topic.empty());
    EXPECT_FALSE(read->endpoint.type.empty());
    EXPECT_TRUE(read->endpoint.type_hash.empty() || read->endpoint.type_hash.size() == kHash.size());
  }
  EXPECT_GT(refused, kMutations / 4);
  EXPECT_LE(graph.discovered().size(), static_cast<std::size_t>(kMutations - refused));
}

TEST(ZenohHostile, AttachmentsAreReadWholeOrNot) {
  std::mt19937 random(2);
  const auto good = to_bytes({7, 1, gid_of_token(kToken)});
  SequenceGaps gaps;
  int refused = 0;
  for (int i = 0; i < kMutations; ++i) {
    const auto bytes = mutated(std::vector<std::uint8_t>(good.begin(), good.end()), random);
    const auto read = parse_attachment(bytes);
    if (!read) {
      ++refused;
      continue;
    }
    EXPECT_EQ(bytes.size(), kAttachmentSize);
    EXPECT_GE(read->sequence, 0);
    (void)gaps.count(*read);
  }
  EXPECT_GT(refused, kMutations / 4);
}

TEST(ZenohHostile, NobodyFillsTheMemoryWithNames) {
  ZenohGraph graph(*session_guid("1"));
  for (int i = 0; i < 3 * kMutations; ++i)
    graph.take(endpoint_token({0, "2", "n"}, i, "t", string_type(), kStream, true), true);
  EXPECT_EQ(graph.discovered().size(), 10'000U);
}

}  // namespace
}  // namespace rds::bus::detail
