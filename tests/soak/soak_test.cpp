// SPDX-License-Identifier: Apache-2.0
// Half an hour in one room where people walk: memory, disk and bytes on the bus of five services stay what
// they were after ten minutes. RDS_SOAK_MINUTES shortens it; then a third of it is what is not looked at.
#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "common/bus/participant.hpp"
#include "common/messages/registry.hpp"
#include "tests/integration/fleet.hpp"
#include "tests/soak/process_sample.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;

constexpr int kDomain = 172;
constexpr double kFlat = 1.05;  // times what it was
constexpr auto kSample = 10s;
// What a curve may wander by without being said to grow: pages, and messages that fall into one sample or the
// next.
constexpr double kMemoryNoise = 2e6;
constexpr double kDiskNoise = 2e6;
constexpr double kTopicNoise = 2e3;  // bytes/s

const std::map<std::string, std::string> kTopics{
    {"rds/tracking_state", "rds_msgs::msg::dds_::TrackingState_"},
    {"rds/predicted_boxes", "rds_msgs::msg::dds_::PredictedBoxes_"},
    {"rds/keyframe/images", "rds_msgs::msg::dds_::KeyFrameImages_"},
    {"rds/keyframe/features", "rds_msgs::msg::dds_::KeyFrameFeatures_"},
    {"rds/keyframe/poses", "rds_msgs::msg::dds_::KeyFramePoses_"},
    {"rds/detections", "vision_msgs::msg::dds_::Detection2DArray_"},
    {"rds/boxes", "vision_msgs::msg::dds_::Detection3DArray_"},
    {"rds/map/delta", "rds_msgs::msg::dds_::OctreeDelta_"},
    {"rds/map/info", "rds_msgs::msg::dds_::MapInfo_"},
    {"rds/map/full", "octomap_msgs::msg::dds_::Octomap_"},
    {"rds/services", "rds_msgs::msg::dds_::ServiceStatus_"},
    {"diagnostics", "diagnostic_msgs::msg::dds_::DiagnosticArray_"}};

/// Counts the bytes of every topic of ours.
class Meter {
 public:
  Meter() {
    for (const auto& [topic, type] : kTopics) {
      const auto* known = messages::find_message_type(type);
      if (known == nullptr) throw std::runtime_error(type + ": no such type");
      subscriptions_.push_back(bus_->make_subscription(
          topic, *known->ops, {.reliable = true},
          [this, topic = topic, known](const std::shared_ptr<const void>& m, const bus::ParticipantId&) {
            const std::lock_guard lock(mutex_);
            bytes_[topic] += known->ops->encoded_size(m.get());
          }));
    }
  }
  /// Since the last call.
  std::map<std::string, std::uint64_t> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(bytes_, {});
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::uint64_t> bytes_;
  std::unique_ptr<bus::Participant> bus_ =
      bus::Participant::create({.domain = kDomain, .node_name = "meter", .loopback_only = true});
  std::vector<std::unique_ptr<bus::detail::SubscriptionEndpoint>> subscriptions_;
};

/// A figure over time, and by how much it may wander.
struct Curve {
  double noise = 0;
  std::vector<double> values;
};
using Curves = std::map<std::string, Curve>;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Medians of the first and the last third of what comes after the first third of a curve.
std::pair<double, double> begin_and_end(const Curve& curve) {
  const auto third = static_cast<std::ptrdiff_t>(curve.values.size() / 3);
  const auto width = std::max<std::ptrdiff_t>(1, 2 * third / 3);
  const auto begin = curve.values.begin() + third;
  return {median({begin, begin + width}), median({curve.values.end() - width, curve.values.end()})};
}

void sample(const Fleet& fleet, Meter& meter, Curves& curves) {
  const auto note = [&](const std::string& name, double noise, double value) {
    curves[name].noise = noise;
    curves[name].values.push_back(value);
  };
  std::uint64_t disk = disk_of(fleet.maps());
  for (std::size_t i = 0; i < fleet.services().size(); ++i) {
    const pid_t process = fleet.services()[i]->pid();
    note(std::string("memory ") + *(Fleet::kServices.begin() + i), kMemoryNoise,
         static_cast<double>(memory_of(process)));
    disk += nameless_files_of(process);
  }
  note("disk", kDiskNoise, static_cast<double>(disk));
  auto bytes = meter.take();
  for (const auto& [topic, type] : kTopics)
    note(topic, kTopicNoise, static_cast<double>(bytes[topic]) / static_cast<double>(kSample.count()));
}

void write_table(const Curves& curves, const std::string& path) {
  std::ofstream file(path);
  for (const auto& [name, curve] : curves) file << name << fmt::format(",{}\n", fmt::join(curve.values, ","));
}

double minutes() {
  const char* given = std::getenv("RDS_SOAK_MINUTES");
  return given == nullptr ? 30 : std::stod(given);
}

/// A room with two people who walk, 12 s.
std::filesystem::path render(const TemporaryFolder& place) {
  const auto rendered = run_process({rds(), "simulate", "--out", (place / "room").string(), "--path", "xyz",
                                     "--people", "2", "--seconds", "12", "--seed", "1"},
                                    300s);
  if (rendered.status != 0) throw std::runtime_error(rendered.standard_error);
  return place / "room";
}

TEST(Soak, FiveServicesStayWhatTheyAre) {
  const TemporaryFolder place;
  const auto room = render(place);
  Fleet fleet(kDomain, "fastdds");
  Meter meter;
  Process player(fleet.player(room, "0.5"));  // 15 Hz
  Curves curves;
  const auto samples = static_cast<int>(minutes() * 60 / static_cast<double>(kSample.count()));
  auto next = std::chrono::steady_clock::now();
  for (int i = 0; i < samples; ++i) {
    std::this_thread::sleep_until(next += kSample);
    sample(fleet, meter, curves);
    ASSERT_TRUE(fleet.all_run()) << fleet.log();
    ASSERT_TRUE(player.running()) << player.standard_error();
  }
  write_table(curves, "soak.csv");
  for (const auto& [name, curve] : curves) {
    const auto [begin, end] = begin_and_end(curve);
    fmt::print("{:28} {:12.0f} -> {:12.0f}  {:.3f}\n", name, begin, end, begin > 0 ? end / begin : 1.0);
    EXPECT_LE(end, kFlat * begin + curve.noise) << name;
  }
  EXPECT_GT(begin_and_end(curves.at("rds/tracking_state")).second, 0) << "nobody tracked";
}

}  // namespace
}  // namespace rds::test
