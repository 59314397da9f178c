// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/concurrency/mailbox.hpp"
#include "common/messages/conversions.hpp"
#include "common/topics/endpoints.hpp"
#include "rds_msgs/msg/TrackingState.h"
#include "tools/rds/cli/bus_options.hpp"
#include "tools/rds/cli/commands.hpp"
#include "tools/rds/cli/interrupt.hpp"
#include "tools/rds/cli/rate_option.hpp"
#include "tools/rds/cli/recording_option.hpp"
#include "tools/rds/play/player.hpp"
#include "tools/rds/play/sensor_choice.hpp"
#include "tools/recording/open_recording.hpp"

namespace rds::play {
namespace {

constexpr int kBadUsage = 2;
constexpr std::chrono::seconds kReaderLimit{10};
constexpr std::chrono::seconds kAcknowledgeLimit{120};  // in lockstep it may adjust a large map

struct PlayOptions {
  std::filesystem::path dataset;
  PlayerOptions player;
  std::filesystem::path odometry;  // empty: the recording's, if it has one
  BusOptions bus;
};

/// Waits for a tracker's acknowledgements, for --rate max.
class Acknowledgements {
 public:
  explicit Acknowledgements(bus::Participant& bus)
      : stamps_(mailbox_, 1000),
        subscription_(topics::subscribe(bus, topics::kTrackingState, topics::kPlayer, [this](const auto& m) {
          stamps_.push(messages::to_nanoseconds(m->header().stamp()));
        })) {}

  /// @return false if no acknowledgement of this frame or a later one came in time.
  bool wait(std::int64_t stamp_ns, const std::stop_token& stop) {
    const auto deadline = std::chrono::steady_clock::now() + kAcknowledgeLimit;
    while (std::chrono::steady_clock::now() < deadline && !stop.stop_requested()) {
      mailbox_.wait_for(stop, std::chrono::milliseconds(200), [this] { return !stamps_.locked_empty(); });
      while (const auto acknowledged = stamps_.try_pop())
        if (*acknowledged >= stamp_ns) return true;
    }
    return false;
  }

 private:
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<std::int64_t> stamps_;
  bus::Subscription subscription_;
};

/// Gives readers that are already there the time to be found; a camera does not wait for anybody for ever.
void wait_for_reader(const Player& player, const std::stop_token& stop) {
  concurrency::Mailbox timer;
  const auto deadline = std::chrono::steady_clock::now() + kReaderLimit;
  while (player.readers() == 0 && !stop.stop_requested() && std::chrono::steady_clock::now() < deadline)
    timer.wait_for(stop, std::chrono::milliseconds(20), [] { return false; });
  timer.wait_for(stop, std::chrono::milliseconds(500), [] { return false; });
}

int play(const PlayOptions& options) {
  const auto opened = recording::open_recording(options.dataset);
  if (!opened) throw std::runtime_error(opened.error());
  fmt::print(stderr, "{}", opened->notes);
  const image::Recording& recording = *opened->recording;
  check_first_frame(recording, options.player.start);
  const Interrupt interrupt;
  const auto bus = bus::Participant::create(options.bus.participant("rds_play"));
  Acknowledgements acknowledgements(*bus);
  PlayerOptions what = options.player;
  what.sensors = chosen_sensors(
      recording, {.imu = recording.sensors().imu.has_value(),
                  .odometry = !options.odometry.empty() || recording.sensors().odometry.has_value(),
                  .odometry_file = options.odometry});
  Player player(*bus, recording, what);
  wait_for_reader(player, interrupt.token());
  bool acknowledged = true;
  const PlayerReport report = player.run(interrupt.token(), [&](const image::RgbdFrame& frame, std::size_t) {
    if (options.player.rate == 0) acknowledged = acknowledgements.wait(frame.stamp_ns, interrupt.token());
    return acknowledged;
  });
  fmt::print("{} frames played, {} unreadable\n", report.played, report.unreadable);
  if (report.unreadable > 0) fmt::print(stderr, "{}\n", report.first_error);
  if (!acknowledged && !interrupt.token().stop_requested())
    fmt::print(stderr, "no tracker acknowledged a frame within {} s\n", kAcknowledgeLimit.count());
  return acknowledged && report.played > 0 ? 0 : 1;
}

}  // namespace

void add_play_command(CLI::App& rds) {
  auto* command = rds.add_subcommand("play", "publish a recording as a robot would: camera, odometry, IMU");
  auto options = std::make_shared<PlayOptions>();
  options->bus.secure.identities = {"player", "operator"};
  add_recording_option(*command, options->dataset)->required();
  add_rate_option(*command, options->player.rate);
  command->add_option("--start", options->player.start, "first frame");
  command->add_option("--frames", options->player.frames, "number of frames")->check(CLI::PositiveNumber);
  command->add_flag("--loop", options->player.loop, "over and over, time going on");
  command->add_option("--odometry", options->odometry,
                      "TUM trajectory of the camera to publish as the robot's odometry, on odom (default: "
                      "the recording's, if it has one; so is its IMU, on imu)");
  add_bus_options(*command, options->bus);
  command->callback([options] {
    int status = kBadUsage;
    try {
      status = play(*options);
    } catch (const std::exception& e) {
      fmt::print(stderr, "{}\n", e.what());
    }
    if (status != 0) throw CLI::RuntimeError(status);
  });
}

}  // namespace rds::play
