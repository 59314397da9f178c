// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/frame_input.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <spdlog/spdlog.h>

#include "common/messages/camera_conversions.hpp"
#include "sensor_msgs/msg/CameraInfo.h"
#include "sensor_msgs/msg/CompressedImage.h"
#include "sensor_msgs/msg/Image.h"

namespace rds::tracker {
namespace {

using bus::DiscoveredEndpoint;
using messages::to_nanoseconds;
using sensor_msgs::msg::CameraInfo;
using sensor_msgs::msg::CompressedImage;
using sensor_msgs::msg::Image;

constexpr std::size_t kLiveFrames = 5;  // that wait, as the topic keeps; older ones are dropped
constexpr std::chrono::milliseconds kLookPeriod{250};

double seconds_since(std::chrono::steady_clock::time_point then) {
  if (then == std::chrono::steady_clock::time_point()) return StreamSight::kNever;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

bool is_published(const std::vector<DiscoveredEndpoint>& endpoints, const std::string& full_name) {
  return std::ranges::any_of(
      endpoints, [&](const DiscoveredEndpoint& e) { return e.publisher && e.topic == full_name; });
}

/// "camera/depth/camera_info" of "camera/depth/image_raw".
std::string info_beside(const std::string& topic) {
  const std::size_t slash = topic.find_last_of('/');
  return (slash == std::string::npos ? "" : topic.substr(0, slash + 1)) + "camera_info";
}

}  // namespace

FrameInput::FrameInput(service::ServiceContext& context, concurrency::Mailbox& mailbox,
                       const CameraTopics& topics, bool lockstep, image::PictureRegistration::LookUp look_up)
    : context_(context),
      topics_(topics),
      qos_(topics.best_effort ? bus::kSensorBestEffort : lockstep ? bus::kSensorLockstep : bus::kSensor),
      registration_(std::move(look_up)),
      pairer_(std::llround(topics.pairing_tolerance_s * 1e9)),
      frames_(mailbox, lockstep ? std::numeric_limits<std::size_t>::max() : kLiveFrames),
      stamps_(!lockstep),
      info_{.topic = topics.camera_info},
      depth_info_{.topic = topics.depth_info.empty() ? info_beside(topics.depth) : topics.depth_info},
      color_{.topic = topics.color},
      depth_{.topic = topics.depth} {
  const auto lens = [](const auto& m) { return messages::to_lens(*m); };
  info_.raw = read<CameraInfo>(info_, info_.topic, lens,
                               [this](const auto& m, const auto& l) { return take_info(m->header(), l); });
  depth_info_.raw =
      read<CameraInfo>(depth_info_, depth_info_.topic, lens, [this](const auto&, const auto& l) {
        const std::lock_guard lock(mutex_);
        registration_.set_depth_lens(l);
        return Taken();
      });
  if (topics.transport != "compressed") {
    color_.raw = read<Image>(
        color_, color_.topic, [](const auto& m) { return messages::camera_color(m); },
        [this](const auto& m, auto picture) { return take_color(m->header(), std::move(picture)); });
    depth_.raw = read<Image>(
        depth_, depth_.topic, [](const auto& m) { return messages::camera_depth(m); },
        [this](const auto& m, auto picture) { return take_depth(m->header(), std::move(picture)); });
  }
  tell_figures();
  watcher_ = std::jthread([this](const std::stop_token& stop) {
    concurrency::Mailbox nothing;
    while (!stop.stop_requested()) {
      look();
      nothing.wait_for(stop, kLookPeriod, [] { return false; });
    }
  });
}

void FrameInput::tell_figures() {
  service::Diagnostics& diagnostics = context_.diagnostics;
  diagnostics.gauge("frames waiting", [this] { return frames_.size(); });
  diagnostics.gauge("frames dropped", [this] { return frames_.dropped(); });
  diagnostics.gauge("pictures without partner", [this] {
    const std::lock_guard lock(mutex_);
    return pairer_.unpaired();
  });
  diagnostics.gauge("frames without depth", [this] {
    const std::lock_guard lock(mutex_);
    return pairer_.without_depth();
  });
  for (const std::string& name : kCameraFaults)
    diagnostics.warning(name, [this, name]() -> std::optional<std::string> {
      const std::lock_guard lock(mutex_);
      const auto fault = faults_.find(name);
      return fault == faults_.end() ? std::nullopt : std::optional(fault->second);
    });
}

template <class Message, class Convert, class Take>
bus::Subscription FrameInput::read(Stream& stream, const std::string& topic, Convert convert, Take take) {
  return context_.bus.subscribe<Message>(
      topic, qos_, [this, &stream, topic, convert, take](const std::shared_ptr<const Message>& message) {
        auto converted = convert(message);
        const Taken taken =
            converted ? take(message, std::move(*converted)) : tl::unexpected(converted.error());
        {
          const std::lock_guard lock(mutex_);
          (taken ? stream.used : stream.refused) = Clock::now();
          if (!taken) stream.refusal = taken.error();
        }
        if (!taken) context_.diagnostics.reject(topic, service::Rejection::kInvalid, taken.error());
      });
}

FrameInput::Taken FrameInput::take_info(const std_msgs::msg::Header& header, const geometry::Lens& lens) {
  const std::lock_guard lock(mutex_);
  const bool is_first = !registration_.knows_lens();
  registration_.set_color_lens(lens, header.frame_id());
  if (is_first && !registration_.leaves_early_pictures()) pairer_.forget_waiting();
  pass_on(pairer_.set_camera(lens.camera()));
  return {};
}

FrameInput::Taken FrameInput::take_color(const std_msgs::msg::Header& header, image::ColorImage picture) {
  const auto [make, is_early] = [&] {
    const std::lock_guard lock(mutex_);
    return std::pair(registration_.color(picture.pixels.size(), header.frame_id()),
                     !registration_.knows_lens());
  }();
  if (!make) return tl::unexpected(make.error());
  if (*make) picture = (*make)(picture);
  const std::lock_guard lock(mutex_);
  if (is_early && !registration_.leaves_early_pictures()) return {};
  pass_on(pairer_.add_color(to_nanoseconds(header.stamp()), std::move(picture)));
  return {};
}

FrameInput::Taken FrameInput::take_depth(const std_msgs::msg::Header& header, image::DepthImage picture) {
  const std::int64_t stamp_ns = to_nanoseconds(header.stamp());
  const auto [make, is_early] = [&] {
    const std::lock_guard lock(mutex_);
    return std::pair(registration_.depth(picture.values.size(), header.frame_id(), stamp_ns),
                     !registration_.knows_lens());
  }();
  if (!make) return tl::unexpected(make.error());
  if (*make) picture = (*make)(picture);
  const std::lock_guard lock(mutex_);
  if (is_early && !registration_.leaves_early_pictures()) return {};
  pass_on(pairer_.add_depth(stamp_ns, std::move(picture)));
  return {};
}

void FrameInput::pass_on(FramePairer::Frames frames) {
  if (pairer_.last_has_depth() && !frames.empty()) framed_ = Clock::now();
  if (const std::int64_t offset_ns = pairer_.depth_offset_ns(); offset_ns != told_offset_ns_) {
    told_offset_ns_ = offset_ns;
    spdlog::info("{} is stamped {:+.1f} ms after {}, always: they are paired by that", depth_.topic,
                 static_cast<double>(offset_ns) / 1e6, color_.topic);
  }
  for (image::RgbdFrame& frame : frames) frames_.push(std::move(frame));
}

std::string FrameInput::camera_frame() const {
  const std::lock_guard lock(mutex_);
  return registration_.color_frame();
}

void FrameInput::look() {
  const auto endpoints = context_.bus.discovered();
  choose_packing(color_, {color_.topic + "/compressed"}, endpoints);
  choose_packing(depth_, {depth_.topic + "/compressedDepth", depth_.topic + "/compressed"}, endpoints);
  auto faults = filter_.lasting(camera_faults(sight(endpoints)), Clock::now());
  const std::lock_guard lock(mutex_);
  faults_ = std::move(faults);
}

/// Reads compressed pictures where a setting says so, or where nobody publishes others.
void FrameInput::choose_packing(Stream& stream, const std::vector<std::string>& packed_topics,
                                const std::vector<DiscoveredEndpoint>& endpoints) {
  const auto is_there = [&](const std::string& topic) {
    return is_published(endpoints, context_.bus.full_name(topic));
  };
  std::string wanted;
  if (topics_.transport == "compressed" || (topics_.transport == "auto" && !is_there(stream.topic))) {
    const auto found = std::ranges::find_if(packed_topics, is_there);
    if (found != packed_topics.end()) wanted = *found;
  }
  if (wanted == stream.packed_topic) return;
  stream.packed = {};
  stream.packed_topic = wanted;
  if (wanted.empty()) return;
  try {
    read_packed(stream, wanted);
    spdlog::info("reads {}, as nobody publishes {} as it is, or as camera.transport says", wanted,
                 stream.topic);
  } catch (const bus::BusError& e) {
    spdlog::warn("{} cannot be read: {}", wanted, e.what());
  }
}

void FrameInput::read_packed(Stream& stream, const std::string& topic) {
  if (&stream == &color_)
    stream.packed = read<CompressedImage>(
        stream, topic, [](const auto& m) { return messages::camera_color(*m); },
        [this](const auto& m, auto picture) { return take_color(m->header(), std::move(picture)); });
  else
    stream.packed = read<CompressedImage>(
        stream, topic, [](const auto& m) { return messages::camera_depth(*m); },
        [this](const auto& m, auto picture) { return take_depth(m->header(), std::move(picture)); });
}

StreamSight FrameInput::sight_of(const Stream& stream, const std::string& type,
                                 const std::vector<DiscoveredEndpoint>& endpoints) const {
  StreamSight sight{.topic = stream.topic};
  {
    const std::lock_guard lock(mutex_);
    sight.silent_s = seconds_since(stream.used);
    sight.refused_s = seconds_since(stream.refused);
    sight.refusal = stream.refusal;
  }
  const std::string name = context_.bus.full_name(stream.topic);
  const std::string packed = stream.packed_topic.empty() ? "" : context_.bus.full_name(stream.packed_topic);
  for (const DiscoveredEndpoint& endpoint : endpoints) {
    if (!endpoint.publisher) continue;
    if (endpoint.topic == packed || (endpoint.topic == name && endpoint.type == type))
      ++sight.publishers;
    else if (endpoint.topic == name)
      sight.other_type = endpoint.type;
  }
  return sight;
}

CameraSight FrameInput::sight(const std::vector<DiscoveredEndpoint>& endpoints) const {
  CameraSight sight{.color = sight_of(color_, bus::type_ops<Image>().dds_name, endpoints),
                    .info = sight_of(info_, bus::type_ops<CameraInfo>().dds_name, endpoints),
                    .depth = sight_of(depth_, bus::type_ops<Image>().dds_name, endpoints)};
  add_others(endpoints, sight);
  const std::lock_guard lock(mutex_);
  sight.since_frame_s = seconds_since(framed_);
  if (const auto gap_ns = pairer_.partner_gap_ns()) sight.partner_ms = static_cast<double>(*gap_ns) / 1e6;
  return sight;
}

/// The robot's pictures and camera_info that are not read.
void FrameInput::add_others(const std::vector<DiscoveredEndpoint>& endpoints, CameraSight& sight) const {
  const std::string below = context_.node_namespace == "/" ? "" : context_.node_namespace.substr(1) + "/";
  std::set<std::string> read;
  for (const Stream* stream : {&color_, &depth_, &info_, &depth_info_})
    read.insert(context_.bus.full_name(stream->topic));
  for (const DiscoveredEndpoint& endpoint : endpoints) {
    if (!endpoint.publisher || read.contains(endpoint.topic) || !endpoint.topic.starts_with(below)) continue;
    if (endpoint.type == bus::type_ops<Image>().dds_name ||
        endpoint.type == bus::type_ops<CompressedImage>().dds_name)
      sight.other_pictures.push_back(endpoint.topic);
    if (endpoint.type == bus::type_ops<CameraInfo>().dds_name) sight.other_infos.push_back(endpoint.topic);
  }
}

}  // namespace rds::tracker
