// SPDX-License-Identifier: Apache-2.0
// What rmw_zenoh writes on the network, and what anybody may write there.
#include "common/bus/zenoh/wire/zenoh_names.hpp"

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

/// The bytes that xxHash's own checks are made of.
std::string xxhash_bytes(std::size_t count) {
  std::string bytes;
  std::uint64_t generator = 2654435761U;
  for (std::size_t i = 0; i < count; ++i, generator *= 11400714785074694797U)
    bytes.push_back(static_cast<char>(generator >> 56U));
  return bytes;
}

/// Without seed: those of 0 to 512 bytes but for 16, 128, 240 and 241 are published with xxHash
/// (XSUM_XXH128_testdata); those four are what its program xxhsum 0.8.1 (-H2) says.
TEST(ZenohNames, AGidIsXxh3WithTheLowHalfFirst) {
  struct Vector {
    std::size_t bytes;
    std::uint64_t low;
    std::uint64_t high;
  };
  constexpr Vector kVectors[] = {
      {0, 0x6001c324468d497f, 0x99aa06d3014798d8},   {1, 0xc44bdff4074eecdb, 0xa6cd5e9392000f6a},
      {6, 0x3e7039bdda43cfc6, 0x082afe0b8162d12a},   {12, 0x061a192713f69ad9, 0x6e3efd8fc7802b18},
      {16, 0x562980258a998629, 0xc68c368ecf8a9c05},  {24, 0x1e7044d28b1b901d, 0x0ce966e4678d3761},
      {48, 0xf942219aed80f67b, 0xa002ac4e5478227e},  {81, 0x5e8bafb9f95fb803, 0x4952f58181ab0042},
      {128, 0xebb15e34a7fb5ab1, 0x39992220e045260a}, {222, 0xf1aebd597cec6b3a, 0x337e09641b948717},
      {240, 0x5c9aae94c8ebe5a0, 0xaa4202daa2769dc8}, {241, 0xc5a639ecd2030e5e, 0x99a80ecf0ecfc647},
      {403, 0xcdeb804d65c6dea4, 0x1b6de21e332dd73d}, {512, 0x617e49599013cb6b, 0x18d2d110dcc9bca1}};
  for (const Vector& vector : kVectors) {
    Guid expected{};
    for (std::size_t i = 0; i < 16; ++i)
      expected[i] = static_cast<std::uint8_t>((i < 8 ? vector.low : vector.high) >> (8 * (i % 8)));
    EXPECT_EQ(gid_of_token(xxhash_bytes(vector.bytes)), expected) << vector.bytes << " bytes";
  }
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

}  // namespace
}  // namespace rds::bus::detail
