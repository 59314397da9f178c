// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/frame_input.hpp"

#include <cmath>
#include <limits>

#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"

namespace rds::tracker {
namespace {

using messages::to_nanoseconds;
using sensor_msgs::msg::CameraInfo;
using sensor_msgs::msg::Image;

constexpr std::size_t kLiveFrames = 5;  // that wait, as the topic keeps; older ones are dropped

}  // namespace

FrameInput::FrameInput(service::ServiceContext& context, concurrency::Mailbox& mailbox,
                       const CameraTopics& topics, bool lockstep)
    : context_(context),
      pairer_(std::llround(topics.pairing_tolerance_s * 1e9)),
      frames_(mailbox, lockstep ? std::numeric_limits<std::size_t>::max() : kLiveFrames),
      stamps_(!lockstep) {
  const bus::Qos qos = topics.best_effort ? bus::kSensorBestEffort : bus::kSensor;
  subscribe<CameraInfo>(
      topics.camera_info, qos, [](const auto& m) { return messages::to_camera_model(*m); },
      [this](const auto&, auto camera) { return pairer_.set_camera(camera); });
  subscribe<Image>(
      topics.color, qos, [](const auto& m) { return messages::to_color_image(m); },
      [this](const auto& m, auto color) {
        return pairer_.add_color(to_nanoseconds(m->header().stamp()), std::move(color));
      });
  subscribe<Image>(
      topics.depth, qos, [](const auto& m) { return messages::to_depth_image(m); },
      [this](const auto& m, auto depth) {
        return pairer_.add_depth(to_nanoseconds(m->header().stamp()), std::move(depth));
      });
  context.diagnostics.gauge("frames waiting", [this] { return frames_.size(); });
  context.diagnostics.gauge("frames dropped", [this] { return frames_.dropped(); });
  context.diagnostics.gauge("pictures without partner", [this] {
    const std::lock_guard lock(pairer_mutex_);
    return pairer_.unpaired();
  });
  context.diagnostics.gauge("frames without depth", [this] {
    const std::lock_guard lock(pairer_mutex_);
    return pairer_.without_depth();
  });
}

template <class Message, class Convert, class Add>
void FrameInput::subscribe(const std::string& topic, const bus::Qos& qos, Convert convert, Add add) {
  subscriptions_.push_back(context_.bus.subscribe<Message>(
      topic, qos, [this, topic, convert, add](const std::shared_ptr<const Message>& message) {
        auto converted = convert(message);
        if (!converted)
          return context_.diagnostics.reject(topic, service::Rejection::kInvalid, converted.error());
        const std::lock_guard lock(pairer_mutex_);
        for (image::RgbdFrame& frame : add(message, std::move(*converted))) frames_.push(std::move(frame));
      }));
}

}  // namespace rds::tracker
