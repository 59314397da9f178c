// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/foxglove_bridge.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "common/messages/definitions.hpp"
#include "common/topics/topics.hpp"
#include "diagnostic_msgs/msg/DiagnosticArray.h"
#include "nav_msgs/msg/OccupancyGrid.h"
#include "nav_msgs/msg/Odometry.h"
#include "rds_msgs/msg/PredictedBoxes.h"
#include "rds_msgs/msg/TrackingState.h"
#include "sensor_msgs/msg/CameraInfo.h"
#include "sensor_msgs/msg/Image.h"
#include "sensor_msgs/msg/PointCloud2.h"
#include "tf2_msgs/msg/TFMessage.h"
#include "vision_msgs/msg/Detection2DArray.h"
#include "vision_msgs/msg/Detection3DArray.h"
#include "visualization_msgs/msg/MarkerArray.h"

namespace rds::viewer {
namespace {

constexpr std::size_t kMostSamples = 256;               // between two looks of the worker, milliseconds
constexpr const char* kStaticTransforms = "tf_static";  // of the robot

std::uint64_t now_ns() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(since_1970).count());
}

/// What a topic's writer offers; pictures without a claim to each one.
template <class Message>
bus::Qos offered(const topics::Topic<Message>& topic) {
  return topic.writers.begin()->qos;
}

}  // namespace

FoxgloveBridge::FoxgloveBridge(service::ServiceContext& context, const ViewerServiceConfig& config,
                               std::function<void()> notify)
    : context_(context),
      notify_(std::move(notify)),
      session_(fmt::format("{:016x}", context.instance)),
      samples_(mailbox_, kMostSamples) {
  offer<tf2_msgs::msg::TFMessage>(topics::kTransforms.name, offered(topics::kTransforms));
  offer<tf2_msgs::msg::TFMessage>(kStaticTransforms, bus::kLatchedOfEach);
  offer<nav_msgs::msg::Odometry>(topics::kOdometry.name, offered(topics::kOdometry));
  offer<sensor_msgs::msg::Image>(config.color_topic, bus::kSensorBestEffort);
  offer<sensor_msgs::msg::CameraInfo>(config.camera_info_topic, bus::kSensorBestEffort);
  offer<sensor_msgs::msg::Image>(topics::kDepth.name, bus::kSensorBestEffort);
  offer<sensor_msgs::msg::PointCloud2>(topics::kMapPoints.name, offered(topics::kMapPoints));
  offer<sensor_msgs::msg::PointCloud2>(topics::kObstacles.name, offered(topics::kObstacles));
  offer<visualization_msgs::msg::MarkerArray>(topics::kMapMarkers.name, offered(topics::kMapMarkers));
  offer<nav_msgs::msg::OccupancyGrid>(topics::kMapGrid.name, offered(topics::kMapGrid));
  offer<vision_msgs::msg::Detection3DArray>(topics::kMapObjects.name, offered(topics::kMapObjects));
  offer<vision_msgs::msg::Detection3DArray>(topics::kBoxes.name, offered(topics::kBoxes));
  offer<vision_msgs::msg::Detection2DArray>(topics::kDetections.name, offered(topics::kDetections));
  offer<rds_msgs::msg::TrackingState>(topics::kTrackingState.name, offered(topics::kTrackingState));
  offer<rds_msgs::msg::PredictedBoxes>(topics::kPredictedBoxes.name, offered(topics::kPredictedBoxes));
  offer<diagnostic_msgs::msg::DiagnosticArray>(topics::kDiagnostics.name, offered(topics::kDiagnostics));
}

void FoxgloveBridge::stop_listening() {
  for (auto& [channel, topic] : topics_) topic.subscription.reset();
}

template <class Message>
void FoxgloveBridge::offer(const std::string& name, const bus::Qos& qos) {
  const auto id = static_cast<std::uint32_t>(channels_.size() + 1);
  const bus::TypeOps& type = bus::type_ops<Message>();
  channels_.push_back({id, "/" + name, type.ros_name, std::string(messages::definition_of(type.ros_name))});
  topics_.emplace(id, Topic{name, qos, messages::serialized(type), nullptr, std::nullopt});
}

std::unique_ptr<foxglove::FoxgloveClient> FoxgloveBridge::open() {
  if (!bus_) {
    bus::ParticipantOptions options = context_.participant;
    options.node_name += "_foxglove";
    bus_ = bus::Participant::create(options);
  }
  auto client = std::make_unique<foxglove::FoxgloveClient>(
      channels_, session_, [this](foxglove::FoxgloveClient& c, std::uint32_t channel) { hear(c, channel); });
  clients_.insert(client.get());
  return client;
}

/// A topic that is heard already has sent what it has latched: that is handed on from here.
void FoxgloveBridge::hear(foxglove::FoxgloveClient& client, std::uint32_t channel) {
  Topic& topic = topics_.at(channel);
  if (topic.subscription) {
    if (topic.latched) client.push(*topic.latched);
    return;
  }
  topic.subscription = bus_->make_subscription(
      topic.name, topic.type, topic.qos,
      [this, channel](std::shared_ptr<const void> message, const bus::ParticipantId&) {
        const auto serialized =
            std::static_pointer_cast<const messages::SerializedMessage>(std::move(message));
        samples_.push({channel, now_ns(), {serialized, &serialized->bytes}});
        notify_();
      });
}

void FoxgloveBridge::take() {
  while (const auto sample = samples_.try_pop()) {
    Topic& topic = topics_.at(sample->channel);
    if (topic.qos.transient_local) topic.latched = *sample;
    for (foxglove::FoxgloveClient* client : clients_) client->push(*sample);
  }
  leave_unheard();
}

void FoxgloveBridge::close(const foxglove::FoxgloveClient& client) {
  context_.diagnostics.counter("messages skipped for slow Foxglove clients") += client.skipped();
  std::erase_if(clients_, [&](const auto* other) { return other == &client; });
  leave_unheard();
  if (clients_.empty()) bus_.reset();
}

void FoxgloveBridge::leave_unheard() {
  for (auto& [channel, topic] : topics_) {
    if (!topic.subscription) continue;
    const bool is_heard =
        std::ranges::any_of(clients_, [&, id = channel](const auto* client) { return client->hears(id); });
    if (is_heard) continue;
    topic.subscription.reset();
    topic.latched.reset();
  }
}

}  // namespace rds::viewer
