// SPDX-License-Identifier: Apache-2.0
// Spoiled copies of every message that the services read, written while the camera rests. RDS_MUTATIONS says
// how many per topic, RDS_MUTATED_TOPIC that it be of one only.
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "common/commander/commander.hpp"
#include "common/service/peers/peers.hpp"
#include "diagnostic_msgs/msg/DiagnosticArray.h"
#include "rds_msgs/message_fields.hpp"
#include "rds_msgs/msg/Command.h"
#include "rds_msgs/msg/KeyFrameFeatures.h"
#include "rds_msgs/msg/KeyFrameImages.h"
#include "rds_msgs/msg/KeyFramePoses.h"
#include "rds_msgs/msg/ServiceStatus.h"
#include "rds_msgs/msg/TrackingState.h"
#include "sensor_msgs/msg/CameraInfo.h"
#include "sensor_msgs/msg/Image.h"
#include "tests/integration/fleet.hpp"
#include "tests/mutation/stranger.hpp"
#include "tests/soak/process_sample.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/small_dataset.hpp"
#include "vision_msgs/message_fields.hpp"
#include "vision_msgs/msg/Detection2DArray.h"
#include "vision_msgs/msg/Detection3DArray.h"

namespace rds::test {
namespace {

using namespace std::chrono_literals;

constexpr int kDomain = 173;
constexpr std::uint64_t kMany = 10'000;  // messages of each topic, among which buffers reach their size
constexpr auto kDrain = 5s;              // until what was written has been looked at
constexpr auto kRest = 15s;              // until what was freed is given back
constexpr double kMaxGrowthMb = 5;
constexpr double kMaxFreedMb = 34;  // that a service keeps
constexpr int kPoses = 50;          // by which the camera is found again
constexpr std::uint64_t kInstance = 4711;

/// Of a service [MB].
struct Memory {
  double allocated = 0;
  double total = 0;
};
using MemoryOfAll = std::vector<Memory>;  // in the order of Fleet::kServices

void print_growth(const MemoryOfAll& before, const MemoryOfAll& after, const std::string& what) {
  fmt::print("{:40}", what);
  for (std::size_t s = 0; s < after.size(); ++s)
    fmt::print(" {} {:+.1f} ({:+.1f}) MB", *(Fleet::kServices.begin() + s),
               after[s].allocated - before[s].allocated, after[s].total - before[s].total);
  fmt::print("\n");
  std::fflush(stdout);
}

std::uint64_t mutations() {
  const char* given = std::getenv("RDS_MUTATIONS");
  return given == nullptr ? 300 : std::stoull(given);
}

/// Fewer say nothing of memory; then nobody waits for it to be given back.
bool memory_counts() {
  return mutations() >= kMany;
}

/// What the services' diagnostics say of refused messages and of memory.
class DiagnosticsWatch {
 public:
  explicit DiagnosticsWatch(bus::Participant& bus)
      : subscription_(bus.subscribe<diagnostic_msgs::msg::DiagnosticArray>(
            "diagnostics", bus::kStream, [this](const auto& m) {
              const std::lock_guard lock(mutex_);
              for (const auto& status : m->status())
                if (status.name().starts_with("rds-")) take(status);
            })) {}
  std::map<std::string, std::uint64_t> refused() {
    const std::lock_guard lock(mutex_);
    return refused_;
  }
  /// What is said from now on counts.
  void forget_allocated() {
    const std::lock_guard lock(mutex_);
    allocated_.clear();
  }
  /// [MB]
  double allocated(const std::string& service) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, 5s, [&] { return allocated_.contains(service); });
    return allocated_.at(service);
  }

 private:
  void take(const diagnostic_msgs::msg::DiagnosticStatus& status) {
    for (const auto& figure : status.values()) {
      if (figure.key().starts_with("rejected "))
        refused_[status.name() + " " + figure.key()] = std::stoull(figure.value());
      if (figure.key() == "allocated [MB]") allocated_[status.name()] = std::stod(figure.value());
    }
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, double> allocated_;
  std::map<std::string, std::uint64_t> refused_;
  bus::Subscription subscription_;
};

std::vector<std::unique_ptr<Stranger>> strangers(bus::Participant& bus) {
  std::vector<std::unique_ptr<Stranger>> all;
  const auto add = [&]<class Message>(std::type_identity<Message>, const std::string& topic,
                                      const bus::Qos& qos) {
    all.push_back(std::make_unique<StrangerOf<Message>>(bus, topic, qos, all.size() + 1));
  };
  add(std::type_identity<rds_msgs::msg::KeyFramePoses>{}, "rds/keyframe/poses", bus::kPoses);
  add(std::type_identity<rds_msgs::msg::KeyFrameFeatures>{}, "rds/keyframe/features",
      {.transient_local = true, .depth = 20});
  add(std::type_identity<rds_msgs::msg::KeyFrameImages>{}, "rds/keyframe/images", bus::kKeyframeImages);
  add(std::type_identity<vision_msgs::msg::Detection2DArray>{}, "rds/detections", bus::kStream);
  add(std::type_identity<vision_msgs::msg::Detection3DArray>{}, "rds/boxes", bus::kBoxes);
  add(std::type_identity<rds_msgs::msg::Command>{}, "rds/command", bus::kCommand);
  add(std::type_identity<rds_msgs::msg::ServiceStatus>{}, "rds/services", bus::kLatched);
  add(std::type_identity<sensor_msgs::msg::CameraInfo>{}, "camera/color/camera_info", bus::kSensor);
  add(std::type_identity<sensor_msgs::msg::Image>{}, "camera/color/image_raw", bus::kSensor);
  add(std::type_identity<sensor_msgs::msg::Image>{}, "camera/aligned_depth_to_color/image_raw", bus::kSensor);
  const char* only = std::getenv("RDS_MUTATED_TOPIC");
  if (only != nullptr) std::erase_if(all, [only](const auto& stranger) { return stranger->topic() != only; });
  return all;
}

class Mutations : public ::testing::TestWithParam<std::string> {
 protected:
  Mutations() { make_excerpt(recording_of_a_room().folder, place_ / "room", 150); }

  /// Empty where memory does not count.
  MemoryOfAll memory() {
    MemoryOfAll all;
    if (!memory_counts()) return all;
    watch_.forget_allocated();
    for (std::size_t s = 0; s < Fleet::kServices.size(); ++s)
      all.push_back({watch_.allocated(*(Fleet::kServices.begin() + s)),
                     static_cast<double>(memory_of(fleet_.services().at(s)->pid())) / 1e6});
    return all;
  }
  void expect_well(const std::string& after) {
    ASSERT_TRUE(fleet_.all_run()) << "after " << after << "\n" << fleet_.log();
    // One that was stopped for minutes has to find the others again, and what was asked before is lost to it.
    std::map<std::string, std::string> answers;
    for (int asked = 0; asked < 10 && answers.size() < Fleet::kServices.size(); ++asked)
      answers = commander_.ask_status(Fleet::kServices.size(), {}, 3s);
    ASSERT_EQ(answers.size(), Fleet::kServices.size()) << "after " << after;
  }

  /// Strangers that the others take for the tracker: it is silent, and they write as another instance. That
  /// is over before the others' DDS gives it up (lease of 10 s): what follows then is another test's affair.
  void write_as_the_tracker(const std::vector<std::unique_ptr<Stranger>>& all) {
    const pid_t tracker = fleet_.services().front()->pid();
    ::kill(tracker, SIGSTOP);
    std::this_thread::sleep_for(service::Peers::kGoneAfter + 300ms);
    for (const auto& stranger : all) {
      stranger->speak_as(kInstance);
      write(*stranger, mutations());
      EXPECT_TRUE(fleet_.all_run()) << "after " << stranger->topic() << "\n" << fleet_.log();
    }
    EXPECT_EQ(commander_.ask_status(Fleet::kServices.size() - 1, {}, 10s).size(),
              Fleet::kServices.size() - 1);
    ::kill(tracker, SIGCONT);
    expect_well("all of them, written as the tracker");
  }

  static void write(Stranger& stranger, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      stranger.write();
      if (i % 16 == 0) std::this_thread::sleep_for(5ms);
    }
  }
  /// The camera is seen, and found in a map, again.
  void expect_to_go_on() {
    std::atomic<int> poses = 0;
    const auto states =
        bus_->subscribe<rds_msgs::msg::TrackingState>("rds/tracking_state", bus::kStream, [&](const auto& m) {
          if (m->state() == 1) ++poses;  // TRACKING
        });
    Process player(fleet_.player(place_ / "room", "0.3"));
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (poses < kPoses && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(100ms);
    EXPECT_GE(poses, kPoses) << fleet_.log();
  }

  TemporaryFolder place_;
  Fleet fleet_{kDomain, GetParam()};
  std::unique_ptr<bus::Participant> bus_ =
      bus::Participant::create({.vendor = bus::vendor_from_name(GetParam()),
                                .domain = kDomain,
                                .node_name = "stranger",
                                .loopback_only = true});
  commander::Commander commander_{*bus_};
  DiagnosticsWatch watch_{*bus_};
};

/// The camera rests meanwhile: what memory grows by is what strangers have written.
TEST_P(Mutations, EndNothingAndFillNothing) {
  auto player = std::make_unique<Process>(fleet_.player(place_ / "room", "0.3"));
  const auto all = strangers(*bus_);
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (!std::ranges::all_of(all, [](const auto& stranger) { return stranger->is_ready(); })) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "somebody is silent\n" << fleet_.log();
    (void)commander_.ask_status(Fleet::kServices.size(), {}, 300ms);  // commands to spoil
  }
  player.reset();
  // First what costs memory once: statuses make it a service of its own, what it says then begins and
  // corrects maps.
  for (const auto& stranger : all) write(*stranger, mutations() / 2);
  if (memory_counts()) std::this_thread::sleep_for(kRest);
  const auto before = memory();
  for (const auto& stranger : all) {
    const auto before_topic = memory();
    write(*stranger, mutations());
    expect_well(stranger->topic());
    if (memory_counts()) std::this_thread::sleep_for(kDrain);
    print_growth(before_topic, memory(), stranger->topic());
  }
  if (memory_counts()) std::this_thread::sleep_for(kRest);
  const auto after = memory();
  print_growth(before, after, "all topics");
  for (std::size_t s = 0; s < after.size(); ++s) {
    EXPECT_LE(after[s].allocated - before[s].allocated, kMaxGrowthMb) << *(Fleet::kServices.begin() + s);
    EXPECT_LE(after[s].total - before[s].total, kMaxGrowthMb + kMaxFreedMb)
        << *(Fleet::kServices.begin() + s);
  }
  write_as_the_tracker(all);
  for (const auto& [what, count] : watch_.refused()) fmt::print("{}: {}\n", what, count);
  expect_to_go_on();
  for (const std::string topic :
       {"rds/keyframe/poses", "rds/keyframe/features", "rds/keyframe/images", "rds/detections", "rds/boxes"})
    EXPECT_TRUE(std::ranges::any_of(watch_.refused(), [&](const auto& entry) {
      return entry.first.find(topic) != std::string::npos;
    })) << topic;
}

INSTANTIATE_TEST_SUITE_P(Vendors, Mutations, ::testing::ValuesIn(all_vendor_names()), given_name);

}  // namespace
}  // namespace rds::test
