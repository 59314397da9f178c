// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/play/player.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include <fmt/format.h>

#include "common/concurrency/mailbox.hpp"
#include "common/topics/endpoints.hpp"
#include "tools/rds/play/decode_ahead.hpp"
#include "tools/recording/camera_messages.hpp"

namespace rds::play {
namespace {

constexpr std::int64_t kFallbackFrameIntervalNs = 33'333'333;

/// Sleeps until `due`, or until stop is requested.
void sleep_until(std::chrono::steady_clock::time_point due, const std::stop_token& stop) {
  concurrency::Mailbox timer;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(due - std::chrono::steady_clock::now());
  if (left.count() > 0) timer.wait_for(stop, left, [] { return false; });
}

/// By how much stamps of the next pass are later, so that time never goes back.
std::int64_t pass_length_ns(const std::vector<image::FrameRef>& frames, std::size_t first, std::size_t last) {
  const std::int64_t span = frames[last - 1].stamp_ns - frames[first].stamp_ns;
  const auto count = static_cast<std::int64_t>(last - first);
  return span + (count > 1 ? span / (count - 1) : kFallbackFrameIntervalNs);
}

/// @param rate  0: each frame is waited for.
template <class Message>
bus::Publisher<Message> advertise(bus::Participant& bus, const topics::Topic<Message>& topic, double rate) {
  return rate > 0 ? topics::advertise(bus, topic, topics::kPlayer)
                  : bus.advertise<Message>(topic.address(), bus::kSensorLockstep);
}

}  // namespace

void check_first_frame(const image::Recording& dataset, std::size_t start) {
  if (start >= dataset.frames().size())
    throw std::runtime_error(
        fmt::format("--start {}: the recording has {} frames", start, dataset.frames().size()));
  const auto frame = dataset.load(dataset.frames()[start]);
  if (!frame) throw std::runtime_error(frame.error());
}

Player::Player(bus::Participant& bus, const image::Recording& dataset, const PlayerOptions& options)
    : dataset_(dataset),
      options_(options),
      color_(advertise(bus, topics::kColor, options.rate)),
      camera_info_(advertise(bus, topics::kCameraInfo, options.rate)),
      depth_(advertise(bus, topics::kDepth, options.rate)),
      sensors_(bus, options.sensors) {}

std::size_t Player::frame_count() const {
  const std::size_t all = dataset_.frames().size();
  return options_.start >= all ? 0 : std::min(options_.frames, all - options_.start);
}

PlayerReport Player::run(const std::stop_token& stop, const AfterFrame& after_frame) {
  PlayerReport report;
  const std::size_t first = options_.start;
  const std::size_t last = first + frame_count();
  if (first >= last) return report;
  const std::int64_t pass_ns = pass_length_ns(dataset_.frames(), first, last);
  const std::int64_t begin_ns = dataset_.frames()[first].stamp_ns;
  DecodeAhead decoder(dataset_, first, last, options_.loop);
  const auto started = std::chrono::steady_clock::now();
  while (auto decoded = decoder.next(stop)) {
    if (!decoded->frame) {
      ++report.unreadable;
      if (report.first_error.empty()) report.first_error = decoded->frame.error();
      continue;
    }
    image::RgbdFrame& frame = *decoded->frame;
    const std::int64_t shift_ns = static_cast<std::int64_t>(decoded->pass) * pass_ns;
    frame.stamp_ns += shift_ns;
    if (options_.rate > 0) {
      const double since_begin_ns = static_cast<double>(frame.stamp_ns - begin_ns) / options_.rate;
      sleep_until(started + std::chrono::nanoseconds(static_cast<std::int64_t>(since_begin_ns)), stop);
    }
    publish(frame, dataset_.frames()[decoded->index].depth_stamp_ns + shift_ns, shift_ns);
    ++report.played;
    if (stop.stop_requested() || !after_frame(frame, decoded->index)) break;
  }
  return report;
}

void Player::publish(const image::RgbdFrame& frame, std::int64_t depth_stamp_ns, std::int64_t shift_ns) {
  sensors_.publish_through(frame.stamp_ns - shift_ns, shift_ns);
  camera_info_.write(recording::camera_info_message(frame.camera, frame.stamp_ns));
  color_.write(recording::color_message(frame.color, frame.stamp_ns));
  depth_.write(recording::depth_message(frame.depth, depth_stamp_ns));
}

}  // namespace rds::play
