// SPDX-License-Identifier: Apache-2.0
// What is Zenoh's own: domains, strangers that speak plain Zenoh, pieces, losses.
#include <cstdlib>
#include <deque>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/bus/zenoh/wire/zenoh_attachment.hpp"
#include "common/bus/zenoh/wire/zenoh_names.hpp"
#include "common/bus/zenoh/zenoh_library.hpp"
#include "common/bus/zenoh/zenoh_qos.hpp"
#include "common/bus/zenoh/zenoh_settings.hpp"
#include "sensor_msgs/msg/Image.h"
#include "std_msgs/msg/Header.h"
#include "tests/unit/common/bus/bus_test_support.hpp"

namespace rds::bus {
namespace {

using sensor_msgs::msg::Image;
using std_msgs::msg::Header;
using namespace std::chrono_literals;

Header numbered(int number) {
  Header header;
  header.stamp().sec(number);
  return header;
}

std::vector<std::uint8_t> bytes_of(const Header& header) {
  const TypeOps& type = type_ops<Header>();
  std::vector<std::uint8_t> bytes(type.encoded_size(&header));
  bytes.resize(type.encode(&header, bytes.data(), bytes.size()));
  return bytes;
}

/// A program that speaks plain Zenoh.
class Stranger {
 public:
  explicit Stranger(const std::string& key) : publisher_(publisher(key)) {}
  void put(const std::vector<std::uint8_t>& payload, const std::vector<std::uint8_t>& attachment) {
    put_by(publisher_, payload, attachment);
  }
  void put_at(const std::string& key, const std::vector<std::uint8_t>& payload,
              const std::vector<std::uint8_t>& attachment) {
    put_by(publisher(key), payload, attachment);
  }
  detail::ZenohToken say(const std::string& token) { return detail::declare_token(session_, token); }

 private:
  detail::ZenohPublisher publisher(const std::string& key) {
    const RdsZenohPublisherOptions options{.priority = 5,
                                           .express = 1,
                                           .reliable = 1,
                                           .droppable = 0,
                                           .latched = 0,
                                           .cache = 0,
                                           .heartbeat_ms = 0};
    return detail::declare_publisher(session_, key, options);
  }
  void put_by(const detail::ZenohPublisher& publisher, const std::vector<std::uint8_t>& payload,
              const std::vector<std::uint8_t>& attachment) {
    const RdsZenohApi& zenoh = detail::zenoh_library();
    std::uint8_t* data = nullptr;
    RdsZenohBuffer* buffer = zenoh.make_buffer(session_.get(), payload.size(), false, &data);
    std::ranges::copy(payload, data);
    zenoh.put(publisher.get(), buffer, attachment.data(), attachment.size());
  }

  detail::ZenohSession session_ = detail::open_zenoh(
      detail::zenoh_settings({.domain = test_domain(), .node_name = "stranger", .loopback_only = true}),
      nullptr);
  detail::ZenohPublisher publisher_;
};

const detail::Guid kStrangersGid = detail::gid_of_token("stranger");

std::vector<std::uint8_t> attachment(std::int64_t sequence) {
  const auto bytes = detail::to_bytes({sequence, 0, kStrangersGid});
  return {bytes.begin(), bytes.end()};
}

class OnZenoh : public ::testing::Test {
 protected:
  [[nodiscard]] std::uint64_t dropped() const { return reader_side->statistics().at(0).dropped; }
  [[nodiscard]] std::uint64_t delivered() const { return reader_side->statistics().at(0).messages; }

  std::unique_ptr<Participant> reader_side = join(Vendor::kZenoh, "reader");
  Inbox<Header> inbox;
  Subscription subscription = reader_side->subscribe<Header>("numbers", kTransform, inbox.callback());
  std::string key = detail::topic_key(test_domain(), "numbers", type_ops<Header>());
};

TEST_F(OnZenoh, DomainsDoNotMeet) {
  const auto elsewhere = join(Vendor::kZenoh, "elsewhere", test_domain() + 100);
  auto publisher = elsewhere->advertise<Header>("numbers", kTransform);
  const auto here = join(Vendor::kZenoh, "here");
  auto other = here->advertise<Header>("numbers", kTransform);
  ASSERT_TRUE(eventually([&] { return subscription.matched() == 1 && other.matched() == 1; }));
  publisher.write(numbered(1));
  other.write(numbered(2));
  ASSERT_TRUE(eventually([&] { return inbox.size() > 0; }));
  EXPECT_EQ(inbox.messages().front()->stamp().sec(), 2);
  EXPECT_EQ(publisher.matched(), 0);
}

TEST_F(OnZenoh, WhatComesWithoutAnAttachmentIsDroppedAndCounted) {
  Stranger stranger(key);
  ASSERT_TRUE(eventually([&] {
    stranger.put(bytes_of(numbered(1)), {});
    return dropped() > 0;
  }));
  EXPECT_EQ(inbox.size(), 0U);
}

TEST_F(OnZenoh, AStrangersMessageIsHeard) {
  Stranger stranger(key);
  ASSERT_TRUE(eventually([&] {
    stranger.put(bytes_of(numbered(1)), attachment(1));
    return inbox.size() > 0;
  }));
  EXPECT_EQ(*inbox.messages().front(), numbered(1));
}

TEST_F(OnZenoh, MissingNumbersAreCountedAsDropped) {
  Stranger stranger(key);
  ASSERT_TRUE(eventually([&] {
    stranger.put(bytes_of(numbered(1)), attachment(1));
    return inbox.size() > 0;
  }));
  stranger.put(bytes_of(numbered(2)), attachment(5));
  ASSERT_TRUE(eventually([&] { return inbox.messages().back()->stamp().sec() == 2; }));
  EXPECT_EQ(dropped(), 3U);
}

bool soaks() {
  return std::getenv("RDS_SOAK") != nullptr;
}

/// zenoh_hostile_test reads 10^5 of each without the network.
int messages() {
  return soaks() ? 200'000 : 10'000;
}

/// A session has 65536 numbers for keys, and takes none back.
int names() {
  return soaks() ? 20'000 : 1'000;
}

/// Payloads and attachments, mutated: nothing but counts, and the next good message comes.
TEST_F(OnZenoh, HostileMessagesAreCountedAndHurtNobody) {
  const int mutations = messages();
  std::mt19937 random(3);
  Stranger stranger(key);
  Header named = numbered(3);
  named.frame_id("map");
  const auto mutate = [&](std::vector<std::uint8_t> bytes) {
    bytes.resize(std::uniform_int_distribution<std::size_t>(0, bytes.size() + 3)(random));
    for (int i = 0; i < 3 && !bytes.empty(); ++i)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    return bytes;
  };
  for (int i = 0; i < mutations; ++i) {
    const bool payload = i % 2 == 0;
    stranger.put(payload ? mutate(bytes_of(named)) : bytes_of(named),
                 payload ? attachment(1) : mutate(attachment(1)));
  }
  EXPECT_TRUE(eventually([&] {
    stranger.put(bytes_of(numbered(-1)), attachment(2));
    return inbox.size() > 0 && inbox.messages().back()->stamp().sec() == -1;
  }));
  EXPECT_GT(dropped(), 0U);
}

/// Whatever stands where the type's hash does: another version's, or none.
TEST_F(OnZenoh, HostileKeysHurtNobody) {
  std::mt19937 random(4);
  Stranger stranger(key);
  for (int i = names(); i > 0; --i) {
    std::string hash = key.substr(key.rfind('/') + 1);
    for (int k = 0; k < 3; ++k) hash[random() % hash.size()] = static_cast<char>('%' + random() % 90);
    std::erase_if(hash, [](char c) { return std::string("#$*?/").find(c) != std::string::npos; });
    stranger.put_at(key.substr(0, key.rfind('/') + 1) + hash, bytes_of(numbered(3)), attachment(i));
  }
  EXPECT_TRUE(eventually([&] {
    stranger.put(bytes_of(numbered(-1)), attachment(1));
    return inbox.size() > 0 && inbox.messages().back()->stamp().sec() == -1;
  }));
  EXPECT_GT(dropped(), 0U) << "of another version";
}

TEST_F(OnZenoh, HostileTokensAreNoEndpoints) {
  constexpr std::size_t kAtOnce = 2'000;
  const int count = soaks() ? 5'000 : 1'000;  // each costs more than the one before
  Stranger stranger(key);
  std::deque<detail::ZenohToken> tokens;
  const std::string domain = "@ros2_lv/" + std::to_string(test_domain());
  for (int i = 0; i < count; ++i) {
    const std::string name = "%" + std::to_string(i);
    tokens.push_back(stranger.say(domain + "/xyz/0/1/MP/%/%/n/" + name + "/T/RIHS01_/::,1:,:,:,,"));
    tokens.push_back(stranger.say(domain + "/" + name));
    while (tokens.size() > kAtOnce) tokens.pop_front();
  }
  tokens.push_back(stranger.say(domain + "/abc/0/1/MP/%/%/n/%good/T/RIHS01_/::,1:,:,:,,"));
  ASSERT_TRUE(eventually([&] {
    return std::ranges::any_of(reader_side->discovered(), [](const auto& e) { return e.topic == "good"; });
  }));
  EXPECT_EQ(std::ranges::count_if(reader_side->discovered(), [](const auto& e) { return e.publisher; }), 1);
}

/// Of each kind a link may declare 10^4 (common/bus/zenoh/patches/declared.rs), which takes label soak.
TEST_F(OnZenoh, HostileTokensBeyondAllMeasureAreLeftOut) {
  Stranger stranger(key);
  std::vector<detail::ZenohToken> tokens;
  const std::string domain = "@ros2_lv/" + std::to_string(test_domain());
  const auto say = [&](const std::string& name) {
    return stranger.say(domain + "/abc/0/1/MP/%/%/n/%" + name + "/T/RIHS01_/::,1:,:,:,,");
  };
  const auto is_seen = [&](const std::string& name) {
    return std::ranges::any_of(reader_side->discovered(), [&](const auto& e) { return e.topic == name; });
  };
  for (int i = 0; i < (soaks() ? 9'999 : 99); ++i)
    tokens.push_back(stranger.say(domain + "/" + std::to_string(i)));
  const auto last = say("last");
  EXPECT_TRUE(eventually([&] { return is_seen("last"); }));
  const auto one_more = say("one_more");
  EXPECT_EQ(eventually([&] { return is_seen("one_more"); }, soaks() ? 2s : 20s), !soaks());
  tokens.resize(10);
  const auto again = say("again");
  EXPECT_TRUE(eventually([&] { return is_seen("again"); }));
}

TEST_F(OnZenoh, ATopicsNameIsChecked) {
  EXPECT_THROW(reader_side->advertise<Header>("**", kStream), BusError);
  EXPECT_THROW(reader_side->advertise<Header>("a//b", kStream), BusError);
}

TEST_F(OnZenoh, AWriterNeverWaits) {
  const auto writer_side = join(Vendor::kZenoh, "writer");
  const auto read = reader_side->subscribe<Image>("pictures", kSensor, [](const auto&) {});
  auto publisher = writer_side->advertise<Image>("pictures", kSensor);
  ASSERT_TRUE(eventually([&] { return publisher.matched() == 1; }));
  Image picture;
  picture.data().resize(1'500'000);
  auto slowest = 0ns;
  for (int i = 0; i < 100; ++i) {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_TRUE(publisher.write(picture));
    slowest = std::max(slowest, std::chrono::steady_clock::now() - start);
  }
  EXPECT_LT(slowest, 1s);  // one that waits takes seconds
}

/// 100'000 in a loop are more than its thread sends, whether anybody reads them or not.
TEST_F(OnZenoh, AWriterCountsWhatItsQueueDisplaces) {
  const auto writer_side = join(Vendor::kZenoh, "writer");
  auto publisher = writer_side->advertise<Image>("pictures", kSensor);
  for (int i = 0; i < 100'000; ++i) EXPECT_TRUE(publisher.write({}));
  const EndpointStatistics statistics = writer_side->statistics().at(0);
  EXPECT_EQ(statistics.messages, 100'000U);
  EXPECT_GT(statistics.dropped, 0U);
  EXPECT_LT(statistics.dropped, 100'000U);
}

TEST(ZenohQos, PicturesAreAskedForAgainInLockstepOnly) {
  EXPECT_FALSE(detail::recovers(kSensor));
  EXPECT_TRUE(detail::recovers(kSensorLockstep));
}

TEST_F(OnZenoh, TheUsersSettingsWin) {
  const std::string ours =
      detail::zenoh_settings({.domain = 3, .node_name = "n", .peers = {"10.0.0.7", "tls/robot:1"}});
  EXPECT_THAT(ours, ::testing::HasSubstr(R"(["tcp/10.0.0.7:7447","tls/robot:1"])"));
  EXPECT_THAT(ours, ::testing::HasSubstr("224.0.0.224:7003"));
  EXPECT_THAT(ours, ::testing::HasSubstr(R"("tcp":{"so_sndbuf":32768})"));
  EXPECT_THAT(detail::zenoh_settings({.node_name = "n", .loopback_only = true}),
              ::testing::Not(::testing::HasSubstr("so_sndbuf")));
  EXPECT_THROW((void)detail::open_zenoh(ours, "/no/such/file"), BusError);
}

}  // namespace
}  // namespace rds::bus
