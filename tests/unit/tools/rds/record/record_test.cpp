// SPDX-License-Identifier: Apache-2.0
#include <map>

#include <gmock/gmock.h>

#include "tools/rds/record/bag_thread.hpp"
#include "tools/rds/record/topic_choice.hpp"

namespace rds::record {
namespace {

using recording::BagMessage;
using recording::BagTopic;

TEST(TopicChoice, CameraAndOutputsLeaveOutWhatServicesTellEachOther) {
  const auto choice = TopicChoice::camera_and_outputs();
  for (const char* topic :
       {"camera/color/image_raw", "camera/color/camera_info", "camera/aligned_depth_to_color/image_raw", "tf",
        "tf_static", "odom", "imu", "rds/odometry", "rds/keyframe/poses", "rds/map/delta", "rds/map/full",
        "diagnostics"})
    EXPECT_TRUE(choice.contains(topic)) << topic;
  for (const char* topic :
       {"rds/keyframe/images", "rds/transfer/offers", "rds/transfer/mapper", "rds/map/chunks",
        "rds/map/offers", "rds/command", "rds/command_result", "rds/run/request"})
    EXPECT_FALSE(choice.contains(topic)) << topic;
}

TEST(TopicChoice, NamesMayHaveALeadingSlash) {
  const auto choice = TopicChoice::named({"/a/b", "c"});
  EXPECT_TRUE(choice.contains("a/b") && choice.contains("c"));
  EXPECT_FALSE(choice.contains("tf") || TopicChoice::camera().contains("tf"));
  EXPECT_TRUE(TopicChoice::all().contains("anything"));
}

/// Remembers what is written; fails, or waits, as it is told.
class FakeBag final : public recording::BagWriter {
 public:
  struct Log {
    std::vector<BagTopic> topics;
    std::map<std::size_t, std::vector<std::int64_t>> times;
    int flushes = 0;
    bool finished = false;
    std::string fault = {};
    std::mutex writing = {};  // held: the disk is slow
  };
  explicit FakeBag(Log& log) : log_(log) {}
  tl::expected<std::size_t, std::string> add_topic(const BagTopic& topic) override {
    log_.topics.push_back(topic);
    return log_.topics.size() - 1;
  }
  Result write(std::size_t topic, const BagMessage& message) override {
    const std::lock_guard lock(log_.writing);
    if (!log_.fault.empty()) return tl::unexpected(log_.fault);
    log_.times[topic].push_back(message.log_time_ns);
    return {};
  }
  Result flush() override {
    ++log_.flushes;
    return {};
  }
  Result finish() override {
    log_.finished = true;
    return {};
  }

 private:
  Log& log_;
};

Received message(std::size_t topic, std::int64_t time_ns, std::size_t bytes) {
  auto made = std::make_shared<messages::SerializedMessage>();
  made->bytes.resize(bytes);
  return {topic, time_ns, made};
}

TEST(BagThread, WritesAllInOrderBeforeItEnds) {
  FakeBag::Log log;
  BagThread bag(std::make_unique<FakeBag>(log), 1'000'000);
  const auto silent = bag.add_topic({.name = "/silent"});
  const auto topic = bag.add_topic({.name = "/a"});
  for (std::int64_t i = 0; i < 100; ++i) bag.push(message(topic, i, 10));
  ASSERT_TRUE(bag.finish());
  EXPECT_TRUE(log.finished);
  ASSERT_EQ(log.topics.size(), 1U) << "a topic without messages is not announced";
  EXPECT_EQ(log.topics[0].name, "/a");
  ASSERT_EQ(log.times[0].size(), 100U);
  EXPECT_TRUE(std::ranges::is_sorted(log.times[0]));
  EXPECT_EQ(bag.counts()[topic].messages, 100U);
  EXPECT_EQ(bag.counts()[topic].bytes, 1000U);
  EXPECT_EQ(bag.counts()[silent].messages, 0U);
}

TEST(BagThread, DropsAndCountsWhatASlowDiskCannotTake) {
  FakeBag::Log log;
  std::unique_lock slow(log.writing);
  BagThread bag(std::make_unique<FakeBag>(log), 1000);
  const auto topic = bag.add_topic({.name = "/a"});
  for (std::int64_t i = 0; i < 100; ++i) bag.push(message(topic, i, 300));
  slow.unlock();
  ASSERT_TRUE(bag.finish());
  const auto count = bag.counts()[topic];
  EXPECT_EQ(count.messages + count.dropped, 100U);
  EXPECT_GE(count.dropped, 90U);
  EXPECT_GE(count.messages, 3U);
}

TEST(BagThread, AFaultEndsTheWriting) {
  FakeBag::Log log;
  log.fault = "a.mcap: cannot be written: No space left on device";
  BagThread bag(std::make_unique<FakeBag>(log), 1000);
  bag.push(message(bag.add_topic({.name = "/a"}), 1, 10));
  EXPECT_EQ(bag.finish().error(), log.fault);
  EXPECT_TRUE(bag.failed());
  EXPECT_FALSE(log.finished);
}

}  // namespace
}  // namespace rds::record
