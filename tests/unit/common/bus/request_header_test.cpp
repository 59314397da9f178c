// SPDX-License-Identifier: Apache-2.0
#include "common/bus/cyclonedds/request_header.hpp"

#include <gtest/gtest.h>

#include "std_msgs/msg/Header.h"

namespace rds::bus::detail {
namespace {

using std_msgs::msg::Header;

Header header_of(const std::string& frame) {
  Header header;
  header.frame_id(frame);
  header.stamp().sec(7);
  return header;
}

TEST(RequestHeader, StandsBehindTheEncapsulationLittleEndian) {
  const Header message = header_of("map");
  const auto& type = type_ops<Header>();
  MessageBytes plain(type.encoded_size(&message));
  ASSERT_NE(type.encode(&message, plain.data(), plain.size()), 0U);
  const MessageBytes bytes = encode_with_header({0x0102030405060708, -2}, type, &message);
  MessageBytes expected{0, 1, 0, 0, 8, 7, 6, 5, 4, 3, 2, 1, 0xfe, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff};
  expected.insert(expected.end(), plain.begin() + 4, plain.end());
  EXPECT_EQ(bytes, expected);
}

TEST(RequestHeader, IsTakenOutAndLeavesTheMessage) {
  const Header message = header_of("odom");
  MessageBytes bytes = encode_with_header({42, 43}, type_ops<Header>(), &message);
  EXPECT_EQ(take_header(bytes), (RequestHeader{42, 43}));
  Header decoded;
  ASSERT_TRUE(type_ops<Header>().decode(bytes.data(), bytes.size(), &decoded));
  EXPECT_EQ(decoded, message);
}

TEST(RequestHeader, IsReadInTheByteOrderOfTheMessage) {
  MessageBytes bytes{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 0, 0, 0, 3, 9};
  EXPECT_EQ(take_header(bytes), (RequestHeader{0x102, 3}));
  EXPECT_EQ(bytes, (MessageBytes{0, 0, 0, 0, 9}));
}

TEST(RequestHeader, IsMissedInWhatIsTooShortOrOfAnotherEncapsulation) {
  for (std::size_t size = 0; size < 20; ++size) {
    MessageBytes bytes(size, 0);
    EXPECT_FALSE(take_header(bytes)) << size;
    EXPECT_EQ(bytes.size(), size);
  }
  MessageBytes other(24, 0);
  other[1] = 7;  // XCDR2
  EXPECT_FALSE(take_header(other));
}

}  // namespace
}  // namespace rds::bus::detail
