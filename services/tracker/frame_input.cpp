// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/frame_input.hpp"

#include <cmath>

#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"

namespace rds::tracker {

FrameInput::FrameInput(service::ServiceContext& context, concurrency::Mailbox& mailbox,
                       const CameraTopics& topics, std::size_t capacity)
    : context_(context),
      topics_(topics),
      pairer_(std::llround(topics.pairing_tolerance_s * 1e9)),
      frames_(mailbox, capacity) {
  const bus::Qos qos = topics.best_effort ? bus::kSensorBestEffort : bus::kSensor;
  using sensor_msgs::msg::CameraInfo;
  using sensor_msgs::msg::Image;
  subscriptions_.push_back(context.bus.subscribe<CameraInfo>(topics.camera_info, qos,
                                                             [this](const auto& m) { on_camera_info(*m); }));
  subscriptions_.push_back(
      context.bus.subscribe<Image>(topics.color, qos, [this](const auto& m) { on_color(m); }));
  subscriptions_.push_back(
      context.bus.subscribe<Image>(topics.depth, qos, [this](const auto& m) { on_depth(m); }));
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

void FrameInput::on_camera_info(const sensor_msgs::msg::CameraInfo& message) {
  const auto camera = messages::to_camera_model(message);
  if (!camera) return context_.diagnostics.reject(topics_.camera_info, service::Rejection::kInvalid, camera.error());
  const std::lock_guard lock(pairer_mutex_);
  push(pairer_.set_camera(*camera));
}

void FrameInput::on_color(const std::shared_ptr<const sensor_msgs::msg::Image>& message) {
  auto color = messages::to_color_image(message);
  if (!color) return context_.diagnostics.reject(topics_.color, service::Rejection::kInvalid, color.error());
  const std::lock_guard lock(pairer_mutex_);
  push(pairer_.add_color(messages::to_nanoseconds(message->header().stamp()), std::move(*color)));
}

void FrameInput::on_depth(const std::shared_ptr<const sensor_msgs::msg::Image>& message) {
  auto depth = messages::to_depth_image(message);
  if (!depth) return context_.diagnostics.reject(topics_.depth, service::Rejection::kInvalid, depth.error());
  const std::lock_guard lock(pairer_mutex_);
  push(pairer_.add_depth(messages::to_nanoseconds(message->header().stamp()), std::move(*depth)));
}

void FrameInput::push(FramePairer::Frames frames) {
  for (image::RgbdFrame& frame : frames) frames_.push(std::move(frame));
}

}  // namespace rds::tracker
