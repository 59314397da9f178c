// SPDX-License-Identifier: Apache-2.0
// What programs that are no part of a run write on its bus changes nothing of its results.
#include <atomic>

#include <gmock/gmock.h>

#include "common/bus/participant.hpp"
#include "common/commander/commander.hpp"
#include "common/messages/conversions.hpp"
#include "rds_msgs/msg/Command.h"
#include "rds_msgs/msg/KeyFrameFeatures.h"
#include "rds_msgs/msg/KeyFrameImages.h"
#include "rds_msgs/msg/KeyFramePoses.h"
#include "sensor_msgs/msg/Image.h"
#include "tests/integration/run_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr int kDomain = 29;
const std::string kNoUtf8 = "\xFF\xFF";

/// A program that speaks in the tracker's name: it writes spoiled copies of what the tracker has written.
class Impostor {
 public:
  explicit Impostor(bus::Participant& bus)
      : images_(bus.advertise<rds_msgs::msg::KeyFrameImages>("rds/keyframe/images", bus::kKeyframeImages)),
        poses_(bus.advertise<rds_msgs::msg::KeyFramePoses>("rds/keyframe/poses", bus::kLatched)),
        copy_images_(bus.subscribe<rds_msgs::msg::KeyFrameImages>("rds/keyframe/images", bus::kKeyframeImages,
                                                                  [this](const auto& m) { copy(*m); })),
        copy_poses_(bus.subscribe<rds_msgs::msg::KeyFramePoses>("rds/keyframe/poses", bus::kLatchedEvery,
                                                                [this](const auto& m) { copy(*m); })) {}
  [[nodiscard]] int spoken() const { return spoken_; }

 private:
  // Its own messages come back to it: those are left alone.
  static constexpr std::uint64_t kAhead = 1000;  // ids and revisions

  void copy(rds_msgs::msg::KeyFrameImages message) {
    if (message.keyframe_id() >= kAhead) return;
    message.keyframe_id(message.keyframe_id() + kAhead);
    images_.write(message);
    ++spoken_;
  }
  void copy(rds_msgs::msg::KeyFramePoses message) {
    if (message.revision() >= kAhead) return;
    message.base_revision(0);
    message.revision(message.revision() + kAhead);
    for (auto& number : message.poses()) number += 0.01;
    poses_.write(message);
    ++spoken_;
  }

  std::atomic<int> spoken_ = 0;
  bus::Publisher<rds_msgs::msg::KeyFrameImages> images_;
  bus::Publisher<rds_msgs::msg::KeyFramePoses> poses_;
  bus::Subscription copy_images_;
  bus::Subscription copy_poses_;
};

/// A program that speaks of another map, as a second tracker or a mistaken one would.
class Stranger {
 public:
  /// One message of each kind, of an epoch and of instances that nobody knows.
  void speak() {
    rds_msgs::msg::KeyFrameImages keyframe;
    keyframe.header(header_);
    keyframe.instance(4711);
    keyframe.map_epoch(815);
    keyframe.keyframe_id(++id_);
    keyframe.color().encoding(kNoUtf8);
    images_.write(keyframe);
    rds_msgs::msg::KeyFrameFeatures features;
    features.header(header_);
    features.instance(4711);
    features.map_epoch(815);
    features.keyframe_id(id_);
    features_.write(features);
    for (const std::uint8_t source : {std::uint8_t{0}, std::uint8_t{1}}) {
      rds_msgs::msg::KeyFramePoses poses;
      poses.header(header_);
      poses.instance(4711 + source);
      poses.map_epoch(815);
      poses.source(source);
      poses.revision(1000 + id_);
      poses.loop_revision(1000 + id_);
      poses.keyframe_ids({1});
      poses.stamps({0});
      poses.poses({7, 7, 7, 0, 0, 0, 1});
      poses_.write(poses);
    }
    sensor_msgs::msg::Image picture;
    picture.header(header_);
    picture.encoding(kNoUtf8);
    color_.write(picture);
  }
  bus::Participant& bus() { return *bus_; }
  [[nodiscard]] bool is_heard() const { return images_.matched() >= 2 && color_.matched() >= 1; }

 private:
  std::unique_ptr<bus::Participant> bus_ =
      bus::Participant::create({.domain = kDomain, .node_name = "stranger", .loopback_only = true});
  std_msgs::msg::Header header_ = messages::make_header(1'000'000'000, kNoUtf8);
  std::uint64_t id_ = 0;
  bus::Publisher<rds_msgs::msg::KeyFrameImages> images_ =
      bus_->advertise<rds_msgs::msg::KeyFrameImages>("rds/keyframe/images", bus::kKeyframeImages);
  bus::Publisher<rds_msgs::msg::KeyFrameFeatures> features_ =
      bus_->advertise<rds_msgs::msg::KeyFrameFeatures>("rds/keyframe/features", bus::kKeyframeFeatures);
  bus::Publisher<rds_msgs::msg::KeyFramePoses> poses_ =
      bus_->advertise<rds_msgs::msg::KeyFramePoses>("rds/keyframe/poses", bus::kLatched);
  bus::Publisher<sensor_msgs::msg::Image> color_ =
      bus_->advertise<sensor_msgs::msg::Image>("camera/color/image_raw", bus::kSensor);
};

std::vector<std::string> arguments(const std::filesystem::path& data, const std::filesystem::path& out) {
  return {rds(),        "run",    "--dataset", data.string(), "--out",
          out.string(), "--rate", "max",       "--domain",    std::to_string(kDomain)};
}

TEST(Strangers, ChangeNothingOfALockstepRun) {
  RDS_REQUIRE_SHARED("data/7scenes_kitchen");
  const TemporaryFolder place;
  make_excerpt(shared() / "data/7scenes_kitchen", place / "data", 60);
  ASSERT_EQ(run_process(arguments(place / "data", place / "alone"), 120s).status, 0);

  Process disturbed(arguments(place / "data", place / "disturbed"));
  Stranger stranger;
  Impostor impostor(stranger.bus());
  commander::Commander commander(stranger.bus());
  while (!stranger.is_heard()) {
    ASSERT_TRUE(disturbed.running());
    std::this_thread::sleep_for(10ms);
  }
  bool answered = false;
  while (disturbed.running()) {
    stranger.speak();
    const auto all = commander.ask_status(5, {}, 300ms);
    answered |= all.size() == 5;
    const auto wrong = commander.ask("rds-mapper", "finish", R"({"poses_revision": "x"})", {}, 300ms);
    if (wrong) {
      EXPECT_FALSE(wrong->success);
    }
    std::this_thread::sleep_for(200ms);
  }
  EXPECT_EQ(disturbed.wait(1s), 0) << disturbed.standard_error();
  EXPECT_TRUE(answered) << "every service answers status";
  EXPECT_GE(impostor.spoken(), 5);
  for (const char* file : {"trajectory.txt", "keyframes.txt", "predictions.jsonl", "objects.json", "map.ot"})
    EXPECT_EQ(read_text(place / "alone" / file), read_text(place / "disturbed" / file)) << file;
  EXPECT_THAT(read_text(place / "disturbed/log/rds-loop-closer.log"), HasSubstr("another tracker"));
  EXPECT_THAT(read_text(place / "disturbed/log/rds-mapper.log"), HasSubstr("in another one's name"));
  EXPECT_THAT(read_text(place / "disturbed/log/rds-tracker.log"), HasSubstr("\\xFF\\xFF"));
}

}  // namespace
}  // namespace rds::test
