// SPDX-License-Identifier: Apache-2.0
// Peers whose type of the same name is defined otherwise.
#include "common/bus/type_version.hpp"

#include <atomic>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/bus/dds/user_data.hpp"
#include "common/bus/endpoint_directory.hpp"
#include "std_msgs/msg/Header.h"
#include "tests/unit/common/bus/bus_test_support.hpp"

namespace rds::bus {
namespace {

using std_msgs::msg::Header;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::string kOtherHash = "RIHS01_" + std::string(64, '5');

TEST(TypeHash, IsFoundAmongOtherUserData) {
  EXPECT_EQ(detail::type_hash_in("typehash=" + kOtherHash + ";"), kOtherHash);
  EXPECT_EQ(detail::type_hash_in("enclave=/;typehash=" + kOtherHash), kOtherHash);
}

TEST(TypeHash, IsNothingElseThanAHash) {
  EXPECT_EQ(detail::type_hash_in(""), "");
  EXPECT_EQ(detail::type_hash_in(";;;"), "");
  EXPECT_EQ(detail::type_hash_in("typehash=RIHS01_12;"), "");
  EXPECT_EQ(detail::type_hash_in("typehash=RIHS01_" + std::string(64, '\xff') + ";"), "");
  EXPECT_EQ(detail::type_hash_in("typehash=RIHS02_" + std::string(64, '5') + ";"), "");
  EXPECT_EQ(detail::type_hash_in("anothertypehash=" + kOtherHash + ";"), "");
}

TEST(EndpointDirectory, RemembersTheLastWritersThatLeft) {
  using Directory = detail::EndpointDirectory<int>;
  constexpr int kMany = static_cast<int>(Directory::kRemembered) + 100;
  const DiscoveredEndpoint own{"topic", "type", false, "RIHS01_" + std::string(64, '1')};
  Directory directory;
  for (int i = 0; i < kMany; ++i) {
    directory.put(i, {"topic", "type", true, kOtherHash}, {});
    directory.remove(i);
  }
  EXPECT_THAT(directory.endpoints(), IsEmpty());
  const auto others = directory.writers_of_another_version(own);
  EXPECT_EQ(others.size(), Directory::kRemembered);
  EXPECT_TRUE(others.contains(kMany - 1));
}

TypeOps header_type(const std::string& hash) {
  TypeOps type = type_ops<Header>();
  type.type_hash = hash;
  return type;
}

std::atomic<int> decodes = 0;

/// Header, and each message that is decoded counts.
TypeOps counting_type() {
  TypeOps type = type_ops<Header>();
  type.decode = [](const std::uint8_t* bytes, std::size_t size, void* message) {
    ++decodes;
    return type_ops<Header>().decode(bytes, size, message);
  };
  return type;
}

/// A participant that writes Header, defined otherwise, and one that reads it.
class TypeVersion : public ::testing::TestWithParam<VendorPair> {
 protected:
  void SetUp() override { decodes = 0; }

  std::unique_ptr<detail::SubscriptionEndpoint> subscribe(const Qos& qos) {
    const auto keep = [this](const std::shared_ptr<const void>& message, const ParticipantId&) {
      inbox.callback()(std::static_pointer_cast<const Header>(message));
    };
    return reader_side->make_subscription("topic", read_type, qos, keep);
  }
  void write(detail::PublisherEndpoint& publisher, const std::string& text) {
    Header header;
    header.frame_id(text);
    publisher.write(&header);
  }
  std::vector<std::string> heard() const {
    std::vector<std::string> texts;
    for (const auto& message : inbox.messages()) texts.push_back(message->frame_id());
    return texts;
  }
  std::uint64_t refused() const { return reader_side->statistics().at(0).another_version; }

  TypeOps read_type = counting_type();
  TypeOps other_type = header_type(kOtherHash);
  TypeOps unknown_type = header_type("");
  Inbox<Header> inbox;
  std::unique_ptr<Participant> writer_side = join(GetParam().writer, "writer");
  std::unique_ptr<Participant> reader_side = join(GetParam().reader, "reader");
};

TEST_P(TypeVersion, MessagesOfAnotherAreNeverDecoded) {
  auto good_side = join(GetParam().writer, "good");
  auto other = writer_side->make_publisher("topic", other_type, kTransform);
  auto good = good_side->make_publisher("topic", type_ops<Header>(), kTransform);
  auto subscription = subscribe(kTransform);
  ASSERT_TRUE(eventually(
      [&] { return other->matched() == 1 && good->matched() == 1 && subscription->matched() == 2; }));
  for (int i = 0; i < 20; ++i) {
    write(*other, "other");
    write(*good, std::to_string(i));
  }
  ASSERT_TRUE(eventually([&] { return inbox.size() == 20 && refused() == 20; }));
  for (int i = 0; i < 20; ++i) EXPECT_EQ(heard().at(static_cast<std::size_t>(i)), std::to_string(i));
  EXPECT_EQ(decodes, 20);
  EXPECT_EQ(reader_side->statistics().at(0).dropped, 20U);
}

TEST_P(TypeVersion, WhatAnotherWroteBeforeTheReaderCameIsNotDecodedEither) {
  auto other = writer_side->make_publisher("topic", other_type, kLatched);
  write(*other, "other");
  auto subscription = subscribe(kLatched);
  EXPECT_TRUE(eventually([&] { return refused() == 1; }));
  EXPECT_EQ(decodes, 0);
}

TEST_P(TypeVersion, BothSidesNameTheOther) {
  auto other = writer_side->make_publisher("topic", other_type, kStream);
  EXPECT_THAT(reader_side->mismatches(), IsEmpty());
  auto subscription = subscribe(kStream);
  ASSERT_TRUE(eventually(
      [&] { return reader_side->mismatches().size() == 1 && writer_side->mismatches().size() == 1; }));
  const Mismatch seen = reader_side->mismatches().front();
  EXPECT_EQ(seen.theirs.topic, "topic");
  EXPECT_EQ(seen.theirs.type, "std_msgs::msg::dds_::Header_");
  EXPECT_TRUE(seen.theirs.publisher);
  EXPECT_EQ(seen.theirs.type_hash, kOtherHash);
  EXPECT_EQ(seen.own_type_hash, type_ops<Header>().type_hash);
  std::vector<std::string> own_guids;
  for (const auto& endpoint : writer_side->discovered())
    if (endpoint.publisher && endpoint.topic == "topic") own_guids.push_back(endpoint.guid);
  EXPECT_THAT(own_guids, ElementsAre(seen.theirs.guid));
  EXPECT_FALSE(writer_side->mismatches().front().theirs.publisher);
  other.reset();
  EXPECT_TRUE(eventually([&] { return reader_side->mismatches().empty(); }));
}

TEST_P(TypeVersion, WhoAnnouncesNoHashIsHeard) {
  auto unknown = writer_side->make_publisher("topic", unknown_type, kLatched);
  write(*unknown, "plain");
  auto subscription = subscribe(kLatched);
  ASSERT_TRUE(eventually([&] { return inbox.size() == 1; }));
  EXPECT_THAT(heard(), ElementsAre("plain"));
  EXPECT_THAT(reader_side->mismatches(), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(AllVendors, TypeVersion, ::testing::ValuesIn(kAllPairs),
                         [](const auto& instance) { return name_of(instance.param); });

}  // namespace
}  // namespace rds::bus
