// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>

#include <fmt/format.h>
#include <octomap/ColorOcTree.h>

#include "common/bus/participant.hpp"
#include "common/image/tum_dataset.hpp"
#include "common/messages/conversions.hpp"
#include "common/messages/detection_conversions.hpp"
#include "common/messages/image_conversions.hpp"
#include "diagnostic_msgs/msg/DiagnosticArray.h"
#include "rds_msgs/msg/KeyFrameImages.h"
#include "rds_msgs/msg/PredictedBoxes.h"
#include "rds_msgs/msg/TrackingState.h"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "tests/support/map_reader.hpp"
#include "tests/support/process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {

using rds_msgs::msg::TrackingState;

/// Tracker, transformer and mapper as processes; this program is the camera, and a detector that finds a chair
/// in the middle of every keyframe.
class Robot {
 public:
  Robot(const std::filesystem::path& recording, int domain)
      : domain_(domain), dataset_(image::TumDataset::open(recording).value()) {
    for (const auto& frame : dataset_.frames()) frames_.push_back(dataset_.load(frame).value());
    while (color_.matched() < 1 || depth_.matched() < 1 || detections_.matched() < 1)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));  // services find each other, too
  }

  /// Ends the services in order, so that others that start find nobody.
  ~Robot() {
    for (Process* service : {&tracker_, &transformer_, &mapper_}) service->send(SIGTERM);
    for (Process* service : {&tracker_, &transformer_, &mapper_}) service->wait(std::chrono::seconds(10));
  }
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  /// Publishes a frame with this stamp, at 30 Hz at most, and waits for its acknowledgement.
  TrackingState show(std::size_t index, std::int64_t stamp_ns) {
    std::this_thread::sleep_until(next_);
    next_ = std::chrono::steady_clock::now() + std::chrono::milliseconds(33);
    const image::RgbdFrame& frame = frames_.at(index);
    const auto header = messages::make_header(stamp_ns, "camera_color_optical_frame");
    info_.write(messages::to_camera_info(frame.camera, header));
    color_.write(messages::to_image_message(frame.color, header));
    depth_.write(messages::to_image_message(frame.depth, header));
    ++shown_;
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, std::chrono::seconds(20), [this] { return states_.size() >= shown_; }))
      throw std::runtime_error(fmt::format("frame {} was not acknowledged", shown_));
    return states_.back();
  }
  [[nodiscard]] std::int64_t stamp_ns(std::size_t index) const { return frames_.at(index).stamp_ns; }

  /// The map, once all keyframes are in it. @return keys of its occupied voxels.
  std::vector<octomap::OcTreeKey> occupied() {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(120);
    while (keyframes_in_map() < keyframes() && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const auto tree = mapper::tree_from_bytes(map_.bytes(), resolution_m_).value();
    std::vector<octomap::OcTreeKey> keys;
    for (auto leaf = tree->begin_leafs(), end = tree->end_leafs(); leaf != end; ++leaf)
      if (tree->isNodeOccupied(*leaf)) keys.push_back(leaf.getKey());
    return keys;
  }
  std::size_t keyframes() {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(
        std::ranges::count_if(states_, [](const TrackingState& s) { return s.is_keyframe(); }));
  }
  std::size_t keyframes_in_map() {
    const std::lock_guard lock(mutex_);
    return integrated_;
  }
  /// Objects predicted into the newest frame.
  std::size_t predicted() {
    const std::lock_guard lock(mutex_);
    return predicted_;
  }
  /// A figure of the tracker's diagnostics, as its next reports tell it; "" if none does.
  std::string figure(const std::string& name) {
    std::unique_lock lock(mutex_);
    figures_.clear();
    changed_.wait_for(lock, std::chrono::seconds(5), [&] { return figures_.contains(name); });
    return figures_[name];
  }
  std::string log() const { return tracker_.standard_error() + tracker_.standard_output(); }

 private:
  std::vector<std::string> command(const std::string& service) const {
    return {std::string(RDS_BIN_DIR) + "/" + service, "--domain", std::to_string(domain_), "--loopback",
            "--config", (place_ / (service + ".yaml")).string()};
  }
  Process start(const std::string& service, const std::string& settings) {
    write_text(place_ / (service + ".yaml"), settings);
    return Process(command(service));
  }
  template <class Message, class Take>
  bus::Subscription listen(const std::string& topic, const bus::Qos& qos, Take take) {
    return bus_->subscribe<Message>(topic, qos, [this, take](const auto& message) {
      const std::lock_guard lock(mutex_);
      take(*message);
      changed_.notify_all();
    });
  }
  void detect(const rds_msgs::msg::KeyFrameImages& keyframe) {
    const std::vector<messages::ImageDetection> seen{{"chair", 0.9F, {250, 180, 390, 300}, 2}};
    detections_.write(messages::to_detection_message(seen, keyframe.header()));
  }

  int domain_;
  TemporaryFolder place_;
  Process tracker_ = start("rds-tracker", "{}");
  Process transformer_ = start("rds-transformer", "{}");
  Process mapper_ = start("rds-mapper", "{}");
  image::TumDataset dataset_;
  std::vector<image::RgbdFrame> frames_;
  std::chrono::steady_clock::time_point next_;
  std::size_t shown_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<TrackingState> states_;
  std::size_t predicted_ = 0;
  std::size_t integrated_ = 0;
  double resolution_m_ = 0;
  std::map<std::string, std::string> figures_;
  std::unique_ptr<bus::Participant> bus_ =
      bus::Participant::create({.vendor = bus::Vendor::kFastDds,
                                .domain = domain_,
                                .node_name = "robot",
                                .loopback_only = true});
  bus::Publisher<sensor_msgs::msg::CameraInfo> info_ = bus_->advertise<sensor_msgs::msg::CameraInfo>("camera/color/camera_info", bus::kSensor);
  bus::Publisher<sensor_msgs::msg::Image> color_ = bus_->advertise<sensor_msgs::msg::Image>("camera/color/image_raw", bus::kSensor);
  bus::Publisher<sensor_msgs::msg::Image> depth_ =
      bus_->advertise<sensor_msgs::msg::Image>("camera/aligned_depth_to_color/image_raw", bus::kSensor);
  bus::Publisher<vision_msgs::msg::Detection2DArray> detections_ =
      bus_->advertise<vision_msgs::msg::Detection2DArray>("rds/detections", bus::kStream);
  MapReader map_{*bus_};
  std::vector<bus::Subscription> subscriptions_ = [this] {
    std::vector<bus::Subscription> all;
    all.push_back(listen<TrackingState>("rds/tracking_state", bus::kStream,
                                        [this](const auto& m) { states_.push_back(m); }));
    all.push_back(listen<rds_msgs::msg::PredictedBoxes>("rds/predicted_boxes", bus::kStream,
                                                        [this](const auto& m) { predicted_ = m.ids().size(); }));
    all.push_back(listen<rds_msgs::msg::MapInfo>(
        "rds/map/info", bus::kLatched, [this](const auto& m) {
          integrated_ = m.keyframes_integrated();
          resolution_m_ = m.resolution();
        }));
    all.push_back(listen<rds_msgs::msg::KeyFrameImages>("rds/keyframe/images", bus::kKeyframeImages,
                                                        [this](const auto& m) { detect(m); }));
    all.push_back(listen<diagnostic_msgs::msg::DiagnosticArray>(
        "diagnostics", bus::kStream, [this](const auto& m) {
          for (const auto& status : m.status())
            for (const auto& pair : status.values())
              if (status.name() == "rds-tracker") figures_[pair.key()] = pair.value();
        }));
    return all;
  }();
};

}  // namespace rds::test
