// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "common/messages/registry.hpp"
#include "diagnostic_msgs/msg/DiagnosticArray.h"
#include "rcl_interfaces/msg/ParameterDescriptor.h"
#include "rcl_interfaces/msg/ParameterValue.h"
#include "rds_msgs/msg/KeyFrameFeatures.h"
#include "rmw_dds_common/msg/ParticipantEntitiesInfo.h"
#include "sensor_msgs/msg/Image.h"
#include "std_msgs/msg/Header.h"
#include "tests/unit/common/messages/wire_recordings.hpp"

namespace rds::messages {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <class T>
bool decode(const Bytes& bytes, T& message) {
  return bus::type_ops<T>().decode(bytes.data(), bytes.size(), &message);
}

template <class T>
Bytes encode(const T& message) {
  return messages::encode(message_type<T>(), &message);
}

TEST(TypeOps, NamesATypeForDdsAndRos) {
  const bus::TypeOps& ops = bus::type_ops<rds_msgs::msg::KeyFrameFeatures>();
  EXPECT_EQ(ops.dds_name, "rds_msgs::msg::dds_::KeyFrameFeatures_");
  EXPECT_EQ(ops.ros_name, "rds_msgs/msg/KeyFrameFeatures");
  EXPECT_EQ(ops.type_hash.size(), 7U + 64U);
}

TEST(Codec, HeaderHasTheKnownBytes) {
  std_msgs::msg::Header header;
  header.stamp().sec(1);
  header.stamp().nanosec(2);
  header.frame_id("map");
  const Bytes bytes = {0, 1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 4, 0, 0, 0, 'm', 'a', 'p', 0};
  EXPECT_EQ(encode(header), bytes);
  std_msgs::msg::Header decoded;
  ASSERT_TRUE(decode(bytes, decoded));
  EXPECT_EQ(decoded, header);
}

TEST(Codec, ReadsBigEndian) {
  std_msgs::msg::Header header;
  ASSERT_TRUE(decode({0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 4, 'm', 'a', 'p', 0}, header));
  EXPECT_EQ(header.stamp().sec(), 1);
  EXPECT_EQ(header.frame_id(), "map");
}

TEST(Codec, WritesNothingIntoTooLittleRoom) {
  std_msgs::msg::Header header;
  header.frame_id("map");
  Bytes bytes(10);
  EXPECT_EQ(bus::type_ops<std_msgs::msg::Header>().encode(&header, bytes.data(), bytes.size()), 0U);
}

TEST(Codec, RefusesAnUnterminatedString) {
  std_msgs::msg::Header header;
  EXPECT_FALSE(decode({0, 1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 4, 0, 0, 0, 'm', 'a', 'p', 's'}, header));
}

TEST(Codec, AcceptsPaddingAndRefusesMore) {
  Bytes bytes = {0, 1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};
  std_msgs::msg::Header header;
  EXPECT_TRUE(decode(bytes, header));
  bytes.push_back(0);
  EXPECT_FALSE(decode(bytes, header));
}

/// An element of 40 bytes in memory needs at least 8 on the wire: a length the bytes cannot hold allocates
/// nothing.
TEST(Codec, RefusesALengthThatTheBytesCannotHold) {
  const diagnostic_msgs::msg::DiagnosticArray empty;
  Bytes bytes = encode(empty);
  bytes.resize(bytes.size() + 1'000'000);
  for (const int top : {0x00, 0x0F, 0x7F, 0xFF}) {
    for (std::size_t i = 0; i < 3; ++i) bytes[20 + i] = 0xFF;
    bytes[23] = static_cast<std::uint8_t>(top);
    diagnostic_msgs::msg::DiagnosticArray message;
    EXPECT_FALSE(decode(bytes, message));
    EXPECT_LE(message.status().capacity(), 1'000'000U);
  }
}

TEST(Codec, RefusesABoundedStringBeyondItsBound) {
  rmw_dds_common::msg::ParticipantEntitiesInfo info;
  info.node_entities_info_seq().emplace_back().node_name(std::string(256, 'n'));
  rmw_dds_common::msg::ParticipantEntitiesInfo decoded;
  EXPECT_TRUE(decode(encode(info), decoded));
  info.node_entities_info_seq()[0].node_name(std::string(257, 'n'));
  EXPECT_FALSE(decode(encode(info), decoded));
}

TEST(Codec, RefusesMoreElementsThanASequenceMayHave) {
  rcl_interfaces::msg::ParameterDescriptor descriptor;
  descriptor.integer_range().resize(1);
  rcl_interfaces::msg::ParameterDescriptor decoded;
  EXPECT_TRUE(decode(encode(descriptor), decoded));
  descriptor.integer_range().resize(2);
  EXPECT_FALSE(decode(encode(descriptor), decoded));
}

TEST(Codec, ReusesTheMemoryOfAMessage) {
  sensor_msgs::msg::Image image;
  image.data().assign(100'000, 7);
  const Bytes bytes = encode(image);
  sensor_msgs::msg::Image target;
  ASSERT_TRUE(decode(bytes, target));
  const std::uint8_t* memory = target.data().data();
  ASSERT_TRUE(decode(bytes, target));
  EXPECT_EQ(target.data().data(), memory);
}

TEST(Registry, FindsEveryTypeByItsDdsName) {
  EXPECT_GE(message_types().size(), 50U);
  for (const MessageType& type : message_types()) {
    ASSERT_NE(find_message_type(type.ops->dds_name), nullptr) << type.ops->dds_name;
    EXPECT_EQ(find_message_type(type.ops->dds_name)->ops, type.ops);
  }
  EXPECT_EQ(find_message_type("std_msgs::msg::dds_::Int64_"), nullptr);
  EXPECT_EQ(find_message_type(""), nullptr);
}

TEST(Registry, EveryTypeSurvivesJsonAndBytes) {
  for (const MessageType& type : message_types()) {
    const MessagePtr first = make_message(type);
    const MessagePtr second = make_message(type);
    ASSERT_TRUE(type.from_json(type.to_json(first.get()), second.get()).has_value()) << type.ops->ros_name;
    const Bytes bytes = messages::encode(type, second.get());
    EXPECT_EQ(bytes.size(), type.ops->encoded_size(first.get())) << type.ops->ros_name;
    EXPECT_TRUE(type.ops->decode(bytes.data(), bytes.size(), first.get())) << type.ops->ros_name;
  }
}

TEST(FromJson, NamesTheMemberThatIsWrong) {
  std_msgs::msg::Header header;
  const auto error = [&header](const char* text) { return from_json(Json::parse(text), header).error(); };
  EXPECT_EQ(error(R"({"stamp": {"sec": 5000000000}})"), "stamp.sec: 5000000000 is out of range");
  EXPECT_EQ(error(R"({"stamp": {"nanosec": -1}})"), "stamp.nanosec: -1 is out of range");
  EXPECT_EQ(error(R"({"frame_id": 3})"), "frame_id: expected a string");
  EXPECT_EQ(error(R"({"stamp": []})"), "stamp: expected an object");
}

TEST(FromJson, ReadsBooleansOneByOne) {
  rcl_interfaces::msg::ParameterValue value;
  ASSERT_TRUE(from_json(Json::parse(R"({"bool_array_value": [true, false, true]})"), value).has_value());
  EXPECT_EQ(value.bool_array_value(), (std::vector<bool>{true, false, true}));
}

TEST(FromJson, LeavesOtherMembersAlone) {
  std_msgs::msg::Header header;
  header.frame_id("odom");
  ASSERT_TRUE(from_json(Json::parse(R"({"stamp": {"sec": 4}})"), header).has_value());
  EXPECT_EQ(header.stamp().sec(), 4);
  EXPECT_EQ(header.frame_id(), "odom");
}

TEST(ToJson, WritesNanAsNullAndReadsItBack) {
  rds_msgs::msg::KeyFrameFeatures features;
  features.points() = {1.5F, std::numeric_limits<float>::quiet_NaN()};
  const Json json = to_json(features);
  EXPECT_EQ(json["points"].dump(), "[1.5,null]");
  rds_msgs::msg::KeyFrameFeatures read;
  ASSERT_TRUE(from_json(json, read).has_value());
  EXPECT_TRUE(std::isnan(read.points()[1]));
}

}  // namespace
}  // namespace rds::messages
