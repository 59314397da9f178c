// SPDX-License-Identifier: Apache-2.0
#include "services/detector/detector_service.hpp"

#include <limits>

#include <spdlog/spdlog.h>

#include "common/messages/conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"
#include "common/topics/endpoints.hpp"
#include "services/detector/models/model_store.hpp"

namespace rds::detector {
namespace {

constexpr std::size_t kMaxWaiting = 20;

/// A person under another name would become furniture, without a word.
void warn_of_unknown_labels(const NetworkDescription& network, const labels::Table& labels) {
  for (const std::string& label : network.labels)
    if (labels.find(label) == nullptr)
      spdlog::warn(
          "network {}: the table of labels does not know '{}' (setting labels_file): what has it counts as "
          "furniture, it supports the camera's pose and enters the map, even if it moves",
          network.name, label);
}

std::unique_ptr<DetectionSource> make_source(const DetectorServiceConfig& config) {
  if (!config.detections_file.empty()) {
    spdlog::info("boxes from {}", config.detections_file);
    return std::make_unique<RecordedSource>(config.detections_file, config.detector.max_depth_m);
  }
  const Network network = load_network(config.detector.network, model_folders(config.model_dir));
  warn_of_unknown_labels(network.description, config.detector.labels);
  auto source = std::make_unique<NetworkSource>(network, config.detector);
  spdlog::info("network {}, computed by {}, threads: {}", network.description.name, source->library(),
               config.detector.threads);
  return source;
}

}  // namespace

DetectorService::DetectorService(service::ServiceContext& context, const DetectorServiceConfig& config)
    : Service(context),
      lockstep_(config.lockstep),
      tracker_(context.bus, service::kTracker),
      source_(make_source(config)),
      keyframes_(mailbox_, lockstep_ ? std::numeric_limits<std::size_t>::max() : kMaxWaiting),
      detections_(topics::advertise(context.bus, topics::kDetections, topics::kDetector)),
      keyframe_source_(
          context, topics::kDetector,
          [this](auto receiver) {
            return subscribe_to_instances(topics::kKeyframeImages, topics::kDetector, std::move(receiver));
          },
          [this](Keyframe m) { receive(std::move(m)); },
          [this] { return keyframes_.size() + keyframe_transfer::kRoom <= kMaxWaiting; }) {
  context.diagnostics.gauge("keyframes waiting", [this] { return keyframes_.size(); });
  context.diagnostics.gauge("keyframes skipped", [this] { return keyframes_.dropped(); });
}

void DetectorService::reconfigure(const DetectorServiceConfig& config) {
  source_->set_score_threshold(config.detector.score_threshold);
}

void DetectorService::run(const std::stop_token& stop) {
  while (wait(stop, [this] { return !keyframes_.locked_empty() || !commands_.locked_empty(); })) {
    handle_commands();
    if (const auto arrival = lockstep_ ? keyframes_.try_pop() : keyframes_.try_pop_newest())
      guarded(topics::kKeyframeImages.name, [&] { take(*arrival); });
  }
}

/// On the bus's thread: another tracker's keyframes must not push out those that are waited for.
void DetectorService::receive(Keyframe keyframe) {
  if (!tracker_.accept(keyframe->instance(), keyframe->map_epoch() == map_epoch_))
    return context_.diagnostics.reject(topics::kKeyframeImages.name, service::Rejection::kForeign,
                                       "another tracker");
  map_epoch_ = keyframe->map_epoch();
  keyframes_.push({std::move(keyframe)});
}

void DetectorService::take(const Arrival& arrival) {
  if (!paused_) return look_at(arrival);
  ++context_.diagnostics.counter("keyframes while paused");
  if (lockstep_) publish({}, arrival.keyframe);  // the tracker waits
}

void DetectorService::look_at(const Arrival& arrival) {
  const auto started = std::chrono::steady_clock::now();
  const auto frame = messages::to_rgbd_frame(arrival.keyframe);
  if (!frame)
    return context_.diagnostics.reject(topics::kKeyframeImages.name, service::Rejection::kInvalid,
                                       frame.error());
  std::vector<messages::ImageDetection> found;
  for (const Detection& d : source_->detections(*frame))
    found.push_back({.label = d.label, .score = d.score, .box = d.box, .depth_m = d.depth_m});
  publish(found, arrival.keyframe);
  using Milliseconds = std::chrono::duration<double, std::milli>;
  const auto done = std::chrono::steady_clock::now();
  context_.diagnostics.latency("detect").add_ms(Milliseconds(done - started).count());
  context_.diagnostics.latency("lag").add_ms(Milliseconds(done - arrival.time).count());
}

void DetectorService::publish(const std::vector<messages::ImageDetection>& found, const Keyframe& keyframe) {
  detections_.write(messages::to_detection_message(found, keyframe->header()));
}

service::CommandOutcome DetectorService::execute(const std::string& verb, const std::string& /*argument*/) {
  if (verb == "pause" || verb == "resume") {
    paused_ = verb == "pause";
    return {true, paused_ ? "paused" : "resumed"};
  }
  if (verb == "reset") return {true, "nothing is kept between keyframes"};
  return unknown_command(verb);
}

}  // namespace rds::detector
