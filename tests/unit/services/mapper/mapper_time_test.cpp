// SPDX-License-Identifier: Apache-2.0
// Keyframes and boxes whose stamps are of another time than those before.
#include <gtest/gtest.h>

#include "common/messages/detection_conversions.hpp"
#include "tests/unit/services/mapper/mapper_on_the_bus.hpp"

namespace rds::mapper {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

class MapperTimeOnTheBus : public MapperOnTheBus {
 protected:
  MapperServiceConfig waiting_for_boxes(double timeout_s) {
    MapperServiceConfig waiting = config();
    waiting.expect_boxes = true;
    waiting.boxes_timeout_s = timeout_s;
    return waiting;
  }
  void send_at(std::uint64_t id, std::int64_t stamp_ns) {
    KeyframeInput input = SyntheticKeyframe(id, 2.5 + 0.1 * static_cast<double>(id)).make();
    input.stamp_ns = stamp_ns;
    images.write(to_message(input));
  }
  void send_boxes_at(std::int64_t stamp_ns) {
    boxes.write(messages::to_detection_message(std::span<const messages::SpatialDetection>{},
                                               messages::make_header(stamp_ns, "map")));
  }
  bool waits(const std::string& keyframes) {
    return wait_for([&] { return mapper->figure("keyframes waiting") == keyframes; });
  }
};

TEST_F(MapperTimeOnTheBus, KeyframesOfARecordingThatBeginsAgainAreIntegrated) {
  start(config());
  for (std::uint64_t id = 0; id < 6; ++id) send_at(id, (10 + static_cast<std::int64_t>(id % 3)) * kSecond);
  ASSERT_TRUE(has_revision(6));
  const std::lock_guard lock(mutex);
  EXPECT_EQ(info->keyframes_integrated(), 6U);
}

TEST_F(MapperTimeOnTheBus, BoxesAreOfTheNewestKeyframeOfTheirStamp) {
  start(waiting_for_boxes(60));
  for (std::uint64_t lap = 0; lap < 2; ++lap) {
    send_at(lap, 10 * kSecond);
    ASSERT_TRUE(waits("1"));
    send_boxes_at(10 * kSecond);
    ASSERT_TRUE(has_revision(lap + 1));
  }
}

TEST_F(MapperTimeOnTheBus, AKeyframeDoesNotWaitForBoxesForEverWhenTheClockWasSetBack) {
  start(waiting_for_boxes(1.5));
  send_at(0, 2000 * kSecond);
  ASSERT_TRUE(waits("1"));
  send_at(1, 1000 * kSecond);
  EXPECT_TRUE(has_revision(1));
}

TEST_F(MapperTimeOnTheBus, BoxesOfTheFutureDoNotPushOutRealOnes) {
  start(waiting_for_boxes(60));
  for (int i = 0; i < 300; ++i) send_boxes_at((100'000 + i) * kSecond);
  send_at(0, 10 * kSecond);
  ASSERT_TRUE(waits("1"));
  send_boxes_at(10 * kSecond);
  EXPECT_TRUE(has_revision(1));
}

}  // namespace
}  // namespace rds::mapper
