// SPDX-License-Identifier: Apache-2.0
// The loop closer on a bus of its own, beside somebody who plays the tracker.
#include "services/loop_closer/loop_closer_service.hpp"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "common/messages/conversions.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_domain.hpp"

namespace rds::loop_closer {
namespace {

using Features = rds_msgs::msg::KeyFrameFeatures;

std::unique_ptr<bus::Participant> join(const std::string& name) {
  return bus::Participant::create({.vendor = bus::Vendor::kFastDds,
                                   .domain = test::test_domain(),
                                   .node_name = name,
                                   .loopback_only = true});
}

/// Of few features, so that nothing is recognised.
Features keyframe(std::uint64_t id, std::uint64_t epoch = 42) {
  constexpr std::size_t kFeatures = 5;
  Features message;
  message.header(messages::make_header(static_cast<std::int64_t>(id + 1) * 100'000'000, "camera"));
  message.map_epoch(epoch);
  message.instance(7);
  message.keyframe_id(id);
  message.map_from_camera(messages::to_pose_message(geometry::Pose::Identity()));
  message.keypoints().resize(4 * kFeatures);
  message.descriptors().resize(32 * kFeatures, static_cast<std::uint8_t>(id));
  message.points().resize(3 * kFeatures, 1.0F);
  message.map_point_ids().resize(kFeatures);
  return message;
}

class RunningLoopCloser {
 public:
  explicit RunningLoopCloser(const LoopCloserServiceConfig& config)
      : service_(context_, config), worker_([this](const std::stop_token& stop) {
          service_.run(stop);
          service_.close();
        }) {}

  [[nodiscard]] std::string figure(const std::string& name) const {
    for (const auto& [found, value] : diagnostics_.figures())
      if (found == name) return value;
    return "";
  }
  /// Whether it came to know so many within a minute.
  [[nodiscard]] bool comes_to_know(std::size_t keyframes) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (figure("keyframes") != std::to_string(keyframes)) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
  }

 private:
  std::unique_ptr<bus::Participant> bus_ = join("loop_closer");
  service::Diagnostics diagnostics_;
  service::ServiceContext context_{"rds-loop-closer", *bus_, diagnostics_};
  LoopCloserService service_;
  std::jthread worker_;
};

class LoopCloserOnTheBus : public ::testing::Test {
 protected:
  void send(std::uint64_t first, std::uint64_t end, std::uint64_t epoch = 42) {
    for (std::uint64_t id = first; id < end; ++id) features_.write(keyframe(id, epoch));
  }
  [[nodiscard]] LoopCloserServiceConfig lasting() const {
    LoopCloserServiceConfig config;
    config.maps = {.maps_dir = maps_.path().string(), .checkpoint = true, .checkpoint_s = 0.1};
    return config;
  }
  static LoopCloserServiceConfig forgetful() {
    LoopCloserServiceConfig config;
    config.maps.checkpoint = false;
    return config;
  }
  void forget_what_was_sent() {
    features_ = {};
    features_ = bus_->advertise<Features>("rds/keyframe/features", bus::kKeyframeFeatures);
  }

  rds::test::TemporaryFolder maps_;
  std::unique_ptr<bus::Participant> bus_ = join("tracker");
  bus::Publisher<Features> features_ =
      bus_->advertise<Features>("rds/keyframe/features", bus::kKeyframeFeatures);
};

TEST_F(LoopCloserOnTheBus, OneThatStartsLateLosesNoneOfAThousandKeyframes) {
  send(0, 1000);
  const RunningLoopCloser late(forgetful());
  EXPECT_TRUE(late.comes_to_know(1000)) << late.figure("keyframes");
  EXPECT_EQ(late.figure("keyframes dropped"), "0");
}

TEST_F(LoopCloserOnTheBus, GoesOnWithItsKeyframesAfterARestart) {
  send(0, 50);
  { EXPECT_TRUE(RunningLoopCloser(lasting()).comes_to_know(50)); }
  forget_what_was_sent();
  const RunningLoopCloser again(lasting());
  EXPECT_TRUE(again.comes_to_know(50)) << again.figure("keyframes");
  send(50, 60);
  EXPECT_TRUE(again.comes_to_know(60)) << again.figure("keyframes");
  EXPECT_EQ(again.figure("rejected rds/keyframe/features: invalid"), "");
}

TEST_F(LoopCloserOnTheBus, KeyframesThatTheBusStillHasAreNotTakenTwice) {
  send(0, 50);
  { EXPECT_TRUE(RunningLoopCloser(lasting()).comes_to_know(50)); }
  send(50, 70);
  const RunningLoopCloser again(lasting());
  EXPECT_TRUE(again.comes_to_know(70)) << again.figure("keyframes");
  EXPECT_EQ(again.figure("rejected rds/keyframe/features: invalid"), "");
}

TEST_F(LoopCloserOnTheBus, OneMessageAloneBeginsNoOtherEpoch) {
  const RunningLoopCloser closer(forgetful());
  send(0, 50);
  ASSERT_TRUE(closer.comes_to_know(50));
  send(7, 8, 43);  // spoiled
  send(50, 60);
  EXPECT_TRUE(closer.comes_to_know(60)) << closer.figure("keyframes");
  send(0, 2, 44);
  EXPECT_TRUE(closer.comes_to_know(2)) << "both of the other epoch, " << closer.figure("keyframes");
}

TEST_F(LoopCloserOnTheBus, AnotherEpochClearsTheCheckpoint) {
  send(0, 50);
  {
    const RunningLoopCloser first(lasting());
    EXPECT_TRUE(first.comes_to_know(50));
    send(0, 10, 43);
    EXPECT_TRUE(first.comes_to_know(10)) << first.figure("keyframes");
  }
  forget_what_was_sent();
  EXPECT_TRUE(RunningLoopCloser(lasting()).comes_to_know(10));
}

}  // namespace
}  // namespace rds::loop_closer
