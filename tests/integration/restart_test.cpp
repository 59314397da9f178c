// SPDX-License-Identifier: Apache-2.0
// All five services are killed at random moments and started again, under a camera that goes on: they go on
// in the same map.
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <random>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "common/bus/participant.hpp"
#include "common/messages/conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"
#include "rds_msgs/msg/KeyFramePoses.h"
#include "rds_msgs/msg/MapInfo.h"
#include "rds_msgs/msg/TrackingState.h"
#include "tests/integration/fleet.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/shared_data.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr int kDomain = 171;

/// What the services tell.
class Watch {
 public:
  struct Seen {
    std::uint64_t instance = 0;  // of the tracker
    std::uint64_t epoch = 0;
    std::int64_t newest_frame_ns = 0;
    std::optional<Clock::time_point> first_frame;  // of this instance
    std::optional<Clock::time_point> first_pose;
    std::int64_t newest_keyframe_ns = 0;  // in the first poses of this instance
  };
  /// What the mapper tells.
  struct Map {
    std::uint64_t instance = 0;
    std::uint64_t epoch = 0;
    std::uint64_t keyframes = 0;
    std::uint64_t nodes = 0;
  };

  explicit Watch(const std::string& vendor)
      : bus_(bus::Participant::create({.vendor = bus::vendor_from_name(vendor),
                                       .domain = kDomain,
                                       .node_name = "watch",
                                       .loopback_only = true})) {
    listen<rds_msgs::msg::TrackingState>("rds/tracking_state", bus::kStream,
                                         [this](const auto& m) { take(m); });
    listen<rds_msgs::msg::KeyFramePoses>("rds/keyframe/poses", bus::kPoses,
                                         [this](const auto& m) { take(m); });
    listen<rds_msgs::msg::MapInfo>("rds/map/info", bus::kLatched, [this](const auto& m) {
      map_ = {m.instance(), m.map_epoch(), m.keyframes_integrated(), m.node_count()};
    });
  }

  Seen now() {
    const std::lock_guard lock(mutex_);
    return seen_;
  }
  Map map() {
    const std::lock_guard lock(mutex_);
    return map_;
  }
  /// @return false when the time is over.
  template <class Ready>
  bool wait(std::chrono::seconds limit, Ready ready) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, limit, [&] { return ready(seen_, map_); });
  }

 private:
  template <class Message, class Take>
  void listen(const std::string& topic, const bus::Qos& qos, Take take) {
    subscriptions_.push_back(bus_->subscribe<Message>(topic, qos, [this, take](const auto& message) {
      const std::lock_guard lock(mutex_);
      take(*message);
      changed_.notify_all();
    }));
  }
  void meet(std::uint64_t instance, std::uint64_t epoch) {
    if (instance != seen_.instance) seen_ = {};
    seen_.instance = instance;
    seen_.epoch = epoch;
  }
  void take(const rds_msgs::msg::TrackingState& state) {
    meet(state.instance(), state.map_epoch());
    seen_.newest_frame_ns = messages::to_nanoseconds(state.header().stamp());
    if (!seen_.first_frame) seen_.first_frame = Clock::now();
    const bool has_pose = state.state() != 0 && state.state() != 3;
    if (has_pose && !seen_.first_pose) seen_.first_pose = Clock::now();
  }
  void take(const rds_msgs::msg::KeyFramePoses& poses) {
    if (poses.source() != 0) return;
    meet(poses.instance(), poses.map_epoch());
    const auto told = messages::to_keyframe_poses(poses);
    if (told && !told->empty() && seen_.newest_keyframe_ns == 0)
      seen_.newest_keyframe_ns = told->back().stamp_ns;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  Seen seen_;
  Map map_;
  std::unique_ptr<bus::Participant> bus_;
  std::vector<bus::Subscription> subscriptions_;
};

double seconds(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

/// @param before, map  what was seen last before all were killed.
void start_and_go_on(Fleet& fleet, Watch& watch, const Watch::Seen& before, const Watch::Map& map) {
  fleet.start();
  ASSERT_TRUE(watch.wait(60s,
                         [&](const auto& seen, const auto&) {
                           return seen.instance != before.instance && seen.first_pose &&
                                  seen.newest_keyframe_ns != 0;
                         }))
      << "no pose since\n"
      << fleet.log();
  const Watch::Seen after = watch.now();
  const double found_s = seconds(*after.first_pose - *after.first_frame);
  const double lost_s = static_cast<double>(before.newest_frame_ns - after.newest_keyframe_ns) * 1e-9;
  EXPECT_EQ(after.epoch, before.epoch) << fleet.log();
  EXPECT_LE(found_s, 3);
  EXPECT_LE(lost_s, 10);
  ASSERT_TRUE(watch.wait(30s, [&](const auto&, const auto& now) { return now.instance != map.instance; }))
      << "no map since";
  const Watch::Map map_after = watch.map();
  fmt::print(
      "found itself after {:.2f} s, lost {:.1f} s; the mapper goes on with {} of {} keyframes, {} of {} "
      "nodes\n",
      found_s, lost_s, map_after.keyframes, map.keyframes, map_after.nodes, map.nodes);
  EXPECT_EQ(map_after.epoch, map.epoch) << "the mapper's map is another one\n" << fleet.log();
  EXPECT_GE(static_cast<double>(map_after.nodes), 0.8 * static_cast<double>(map.nodes)) << fleet.log();
}

int kills() {
  return std::getenv("RDS_SOAK") != nullptr ? 20 : 3;
}

class Restart : public ::testing::TestWithParam<std::string> {};

TEST_P(Restart, AllFiveGoOnInTheSameMap) {
  const TestRecording room = recording_of_a_room();
  Fleet fleet(kDomain, GetParam());
  Watch watch(GetParam());
  Process player(fleet.player(room.folder, "0.5"));
  ASSERT_TRUE(watch.wait(60s, [](const auto& seen, const auto& map) {
    return seen.first_pose && map.nodes > 0;
  })) << fleet.log();
  std::this_thread::sleep_for(7s);  // a checkpoint is made every five seconds
  std::mt19937 random(7);
  for (int i = 0; i < kills() && !HasFatalFailure(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 6000));
    const Watch::Seen before = watch.now();
    const Watch::Map map = watch.map();
    ASSERT_TRUE(fleet.kill()) << "one was gone before\n" << fleet.last_log();
    start_and_go_on(fleet, watch, before, map);
  }
  ASSERT_TRUE(player.running()) << player.standard_error();
}

INSTANTIATE_TEST_SUITE_P(Vendors, Restart, ::testing::ValuesIn(all_vendor_names()), given_name);

}  // namespace
}  // namespace rds::test
