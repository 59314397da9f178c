// SPDX-License-Identifier: Apache-2.0
// Every combination of vendors, over 127.0.0.1.
#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "common/messages/serialized.hpp"
#include "sensor_msgs/msg/Image.h"
#include "std_msgs/msg/Header.h"
#include "tests/unit/common/bus/bus_test_support.hpp"

namespace rds::bus {
namespace {

using sensor_msgs::msg::Image;
using std_msgs::msg::Header;

Header numbered(int number) {
  Header header;
  header.stamp().sec(number);
  header.frame_id("map");
  return header;
}

class Exchange : public ::testing::TestWithParam<VendorPair> {
 protected:
  /// On Zenoh only what a writer's thread has sent is there for who comes later.
  static void wait_until_sent() {
    if (GetParam().writer == Vendor::kZenoh) std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }

  std::unique_ptr<Participant> writer_side = join(GetParam().writer, "writer");
  std::unique_ptr<Participant> reader_side = join(GetParam().reader, "reader");
};

TEST_P(Exchange, DeliversEveryMessageInOrder) {
  Inbox<Header> inbox;
  auto publisher = writer_side->advertise<Header>("numbers", kTransform);
  auto subscription = reader_side->subscribe<Header>("numbers", kTransform, inbox.callback());
  ASSERT_TRUE(eventually([&] { return publisher.matched() == 1 && subscription.matched() == 1; }));
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(publisher.write(numbered(i)));
  ASSERT_TRUE(eventually([&] { return inbox.size() == 50; }));
  const auto messages = inbox.messages();
  for (int i = 0; i < 50; ++i) EXPECT_EQ(*messages[static_cast<std::size_t>(i)], numbered(i));
}

TEST_P(Exchange, TellsWhoWroteAMessage) {
  const auto other_side = join(GetParam().writer, "other");
  std::mutex mutex;
  std::map<int, std::vector<ParticipantId>> writers;  // by number
  const auto note = [&](const auto& message, const ParticipantId& writer) {
    const std::lock_guard lock(mutex);
    writers[message->stamp().sec()].push_back(writer);
  };
  auto first = writer_side->advertise<Header>("first", kTransform);
  auto second = writer_side->advertise<Header>("second", kTransform);
  auto others = other_side->advertise<Header>("first", kTransform);
  auto read_first = reader_side->subscribe<Header>("first", kTransform, note);
  auto read_second = reader_side->subscribe<Header>("second", kTransform, note);
  ASSERT_TRUE(eventually([&] { return read_first.matched() == 2 && read_second.matched() == 1; }));
  ASSERT_TRUE(eventually([&] { return first.matched() + second.matched() + others.matched() == 3; }));
  first.write(numbered(1));
  second.write(numbered(1));
  others.write(numbered(2));
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return writers[1].size() == 2 && writers[2].size() == 1;
  }));
  EXPECT_EQ(writers[1][0], writers[1][1]);
  EXPECT_NE(writers[1][0], writers[2][0]);
  EXPECT_NE(writers[1][0], ParticipantId{});
}

TEST_P(Exchange, CarriesThreeMegabytes) {
  Inbox<Image> inbox;
  auto publisher = writer_side->advertise<Image>("images", kSensor);
  auto subscription = reader_side->subscribe<Image>("images", kSensor, inbox.callback());
  ASSERT_TRUE(eventually([&] { return publisher.matched() == 1 && subscription.matched() == 1; }));
  Image image;
  image.data().resize(3'000'000);
  for (std::size_t i = 0; i < image.data().size(); ++i)
    image.data()[i] = static_cast<std::uint8_t>(i * 7 / 3);
  for (int i = 0; i < 3; ++i) {
    image.header(numbered(i));
    EXPECT_TRUE(publisher.write(image));
    ASSERT_TRUE(eventually([&] { return inbox.size() == static_cast<std::size_t>(i) + 1; }));
    EXPECT_EQ(*inbox.messages().back(), image);
  }
}

TEST_P(Exchange, LateJoinerGetsTheLatchedMessage) {
  auto publisher = writer_side->advertise<Header>("latched", kLatched);
  publisher.write(numbered(1));
  publisher.write(numbered(2));
  wait_until_sent();
  Inbox<Header> inbox;
  auto subscription = reader_side->subscribe<Header>("latched", kLatched, inbox.callback());
  ASSERT_TRUE(eventually([&] { return inbox.size() >= 1; }));
  EXPECT_EQ(*inbox.messages().front(), numbered(2));
  EXPECT_EQ(inbox.size(), 1U);
}

TEST_P(Exchange, LateJoinerGetsAllKeptMessages) {
  auto publisher = writer_side->advertise<Header>("kept", kKeyframeFeatures);
  for (int i = 0; i < 300; ++i) publisher.write(numbered(i));
  wait_until_sent();
  Inbox<Header> inbox;
  auto subscription = reader_side->subscribe<Header>("kept", kKeyframeFeatures, inbox.callback());
  ASSERT_TRUE(eventually([&] { return inbox.size() == 300; })) << inbox.size();
  EXPECT_EQ(inbox.messages().front()->stamp().sec(), 0);
  EXPECT_EQ(inbox.messages().back()->stamp().sec(), 299);
}

TEST_P(Exchange, BestEffortReaderHearsReliableWriter) {
  Inbox<Header> inbox;
  auto publisher = writer_side->advertise<Header>("sensor", kSensor);
  auto subscription = reader_side->subscribe<Header>("sensor", kSensorBestEffort, inbox.callback());
  ASSERT_TRUE(eventually([&] { return publisher.matched() == 1 && subscription.matched() == 1; }));
  ASSERT_TRUE(eventually([&] {
    publisher.write(numbered(1));
    return inbox.size() > 0;
  }));
}

TEST_P(Exchange, StalledReaderDoesNotBlockTheWriter) {
  std::mutex stall;
  std::unique_lock hold(stall);
  auto publisher = writer_side->advertise<Image>("images", kSensor);
  auto subscription = reader_side->subscribe<Image>(
      "images", kSensor,
      [&stall](const std::shared_ptr<const Image>&) { const std::lock_guard wait(stall); });
  ASSERT_TRUE(eventually([&] { return publisher.matched() == 1 && subscription.matched() == 1; }));
  Image image;
  image.data().resize(1'500'000);
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 40; ++i) EXPECT_TRUE(publisher.write(image));
  EXPECT_LT(std::chrono::steady_clock::now() - start,
            std::chrono::seconds(5));  // a blocked writer takes for ever
  hold.unlock();
}

TEST_P(Exchange, WriterSeesAReaderGo) {
  auto publisher = writer_side->advertise<Header>("numbers", kStream);
  {
    auto subscription = reader_side->subscribe<Header>("numbers", kStream, [](const auto&) {});
    ASSERT_TRUE(eventually([&] { return publisher.matched() == 1; }));
  }
  EXPECT_TRUE(eventually([&] { return publisher.matched() == 0; }));
  EXPECT_TRUE(publisher.write(numbered(1)));
}

TEST_P(Exchange, BothSidesCountTheTraffic) {
  Inbox<Header> inbox;
  auto publisher = writer_side->advertise<Header>("numbers", kStream);
  auto subscription = reader_side->subscribe<Header>("numbers", kStream, inbox.callback());
  ASSERT_TRUE(eventually([&] { return publisher.matched() == 1 && subscription.matched() == 1; }));
  for (int i = 0; i < 3; ++i) publisher.write(numbered(i));
  ASSERT_TRUE(eventually([&] { return inbox.size() == 3; }));
  const auto written = writer_side->statistics();
  const auto read = reader_side->statistics();
  ASSERT_EQ(written.size(), 1U);
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(written[0].messages, 3U);
  EXPECT_EQ(written[0].bytes, 3U * 20U);  // 4 header + 8 stamp + 4 length + "map\0"
  EXPECT_TRUE(written[0].publisher);
  EXPECT_EQ(written[0].matched, 1);
  EXPECT_EQ(read[0].messages, 3U);
  EXPECT_EQ(read[0].bytes, 3U * 20U);
  EXPECT_EQ(read[0].dropped, 0U);
  EXPECT_EQ(read[0].topic, "numbers");
}

TEST_P(Exchange, EachDiscoversTheOther) {
  auto publisher = writer_side->advertise<Header>("numbers", kStream);
  auto subscription = reader_side->subscribe<Image>("images", kStream, [](const auto&) {});
  const auto knows_both = [](const Participant& participant) {
    bool numbers = false;
    bool images = false;
    for (const DiscoveredEndpoint& e : participant.discovered()) {
      numbers |= e.topic == "numbers" && e.type == "std_msgs::msg::dds_::Header_" && e.publisher;
      images |= e.topic == "images" && e.type == "sensor_msgs::msg::dds_::Image_" && !e.publisher;
    }
    return numbers && images;
  };
  EXPECT_TRUE(eventually([&] { return knows_both(*writer_side) && knows_both(*reader_side); }));
}

TEST_P(Exchange, EachKnowsWhatTheOtherOffersAndAsksFor) {
  auto latched = writer_side->advertise<Header>("latched", kLatched);
  auto plain = writer_side->advertise<Header>("plain", kSensorBestEffort);
  const auto offered = [&](const std::string& topic, bool reliable, bool transient_local) {
    return eventually([&] {
      return std::ranges::any_of(reader_side->discovered(), [&](const DiscoveredEndpoint& e) {
        return e.topic == topic && e.publisher && e.reliable == reliable &&
               e.transient_local == transient_local;
      });
    });
  };
  EXPECT_TRUE(offered("latched", true, true));
  EXPECT_TRUE(offered("plain", false, false));
}

TEST_P(Exchange, AReaderThatFollowsItsPublishersHearsBestEffortOnes) {
  auto publisher = writer_side->advertise<Header>("camera", kSensorBestEffort);
  Inbox<Header> inbox;
  auto subscription = reader_side->subscribe<Header>("camera", kSensor, inbox.callback());
  Inbox<Header> strict;
  auto demanding = reader_side->subscribe<Header>("camera", kStream, strict.callback());
  EXPECT_TRUE(eventually([&] {
    publisher.write(numbered(1));
    return inbox.size() > 0;
  }));
  if (GetParam().reader == Vendor::kZenoh) return;  // there every reader hears every writer
  EXPECT_EQ(strict.size(), 0U);
  EXPECT_TRUE(std::ranges::any_of(reader_side->discovered(), [](const DiscoveredEndpoint& e) {
    return e.topic == "camera" && !e.publisher && !e.reliable;
  })) << "and says what it asks for now";
}

TEST_P(Exchange, ATypeMayBeCarriedAsItsBytes) {
  static const TypeOps kSerialized = messages::serialized(type_ops<Header>());
  std::mutex mutex;
  std::vector<std::vector<std::uint8_t>> received;
  auto publisher = writer_side->advertise<Header>("numbers", kTransform);
  const auto subscription = reader_side->make_subscription(
      "numbers", kSerialized, kTransform, [&](std::shared_ptr<const void> message, const ParticipantId&) {
        const std::lock_guard lock(mutex);
        received.push_back(static_cast<const messages::SerializedMessage*>(message.get())->bytes);
      });
  ASSERT_TRUE(eventually([&] { return publisher.matched() == 1 && subscription->matched() == 1; }));
  publisher.write(numbered(7));
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return !received.empty();
  }));
  const std::lock_guard lock(mutex);
  Header header;
  ASSERT_TRUE(type_ops<Header>().decode(received[0].data(), received[0].size(), &header));
  EXPECT_EQ(header, numbered(7));
}

INSTANTIATE_TEST_SUITE_P(AllVendors, Exchange, ::testing::ValuesIn(kAllPairs),
                         [](const auto& instance) { return name_of(instance.param); });

}  // namespace
}  // namespace rds::bus
