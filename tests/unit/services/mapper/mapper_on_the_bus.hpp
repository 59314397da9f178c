// SPDX-License-Identifier: Apache-2.0
// The mapper on a bus of its own, beside somebody who plays tracker, transformer and reader.
#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"
#include "common/transfer/bus/host.hpp"
#include "rds_msgs/msg/TransferOffer.h"
#include "services/mapper/io/map_files.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "services/mapper/mapper_service.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_domain.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {

using test::SyntheticKeyframe;
using Images = rds_msgs::msg::KeyFrameImages;
using Poses = rds_msgs::msg::KeyFramePoses;

inline constexpr std::uint64_t kEpoch = 42;

inline std::unique_ptr<bus::Participant> join(const std::string& name) {
  return bus::Participant::create({.vendor = bus::Vendor::kFastDds,
                                   .domain = rds::test::test_domain(),
                                   .node_name = name,
                                   .loopback_only = true});
}

inline Images to_message(const KeyframeInput& input, std::uint64_t epoch = kEpoch) {
  const auto header = messages::make_header(input.stamp_ns, "camera_color_optical_frame");
  Images message;
  message.header(header);
  message.map_epoch(epoch);
  message.keyframe_id(input.id);
  message.map_from_camera(messages::to_pose_message(input.map_from_camera));
  message.camera_info(messages::to_camera_info(input.camera, header));
  message.color(messages::to_image_message(input.color, header));
  message.depth(messages::to_image_message(input.depth, header));
  return message;
}

/// Whether `condition` became true within 20 s.
template <class Condition>
bool wait_for(Condition condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

/// A mapper process.
class RunningMapper {
 public:
  explicit RunningMapper(const MapperServiceConfig& config)
      : service_(context_, config), worker_([this](const std::stop_token& stop) {
          service_.run(stop);
          service_.close();
        }) {}

  service::CommandOutcome command(const std::string& verb, const std::string& argument = "") {
    std::promise<service::CommandOutcome> outcome;
    service_.post({verb, argument, [&](const service::CommandOutcome& o) { outcome.set_value(o); }});
    return outcome.get_future().get();
  }
  [[nodiscard]] const service::Diagnostics& diagnostics() const { return diagnostics_; }
  std::uint64_t counter(const std::string& name) { return diagnostics_.counter(name); }
  [[nodiscard]] std::string figure(const std::string& name) const {
    for (const auto& [found, value] : diagnostics_.figures())
      if (found == name) return value;
    return "";
  }

 private:
  std::unique_ptr<bus::Participant> bus_ = join("mapper");
  service::Diagnostics diagnostics_;
  service::ServiceContext context_{"rds-mapper", *bus_, diagnostics_};
  MapperService service_;
  std::jthread worker_;
};

class MapperOnTheBus : public ::testing::Test {
 protected:
  /// As a tracker on this machine: otherwise the mapper would wait for 2 s whether it is on another one.
  MapperOnTheBus() {
    rds_msgs::msg::TransferOffer offer;
    offer.host(transfer::this_host());
    offer.map_epoch(kEpoch);
    offers.write(offer);
  }
  MapperServiceConfig config() const {
    MapperServiceConfig config;
    config.maps.maps_dir = maps.path().string();
    config.expect_boxes = false;
    config.maps.checkpoint = false;
    return config;
  }
  void start(const MapperServiceConfig& config) {
    mapper.reset();
    mapper = std::make_unique<RunningMapper>(config);
    ASSERT_TRUE(wait_for([&] { return images.matched() > 0 && boxes.matched() > 0 && poses.matched() > 0; }));
  }
  void send(std::uint64_t id) {
    images.write(to_message(SyntheticKeyframe(id, 2.5 + 0.1 * static_cast<double>(id)).make()));
  }
  bool has_revision(std::uint64_t revision) {
    return wait_for([&] {
      const std::lock_guard lock(mutex);
      return info && info->revision() >= revision;
    });
  }
  /// The mapper's own tree, from its file.
  std::vector<std::uint8_t> saved_tree() {
    EXPECT_TRUE(mapper->command("save", "saved").success);
    return to_bytes(**read_tree(maps / "saved" / "map.ot"));
  }

  rds::test::TemporaryFolder maps;
  std::unique_ptr<bus::Participant> bus = join("others");
  bus::Publisher<rds_msgs::msg::TransferOffer> offers =
      bus->advertise<rds_msgs::msg::TransferOffer>("rds/transfer/offers", bus::kLatched);
  bus::Publisher<Images> images = bus->advertise<Images>("rds/keyframe/images", bus::kKeyframeImages);
  bus::Publisher<Poses> poses = bus->advertise<Poses>("rds/keyframe/poses", bus::kLatched);
  bus::Publisher<vision_msgs::msg::Detection3DArray> boxes =
      bus->advertise<vision_msgs::msg::Detection3DArray>("rds/boxes", bus::kBoxes);
  std::mutex mutex;
  std::shared_ptr<const rds_msgs::msg::MapInfo> info;
  bus::Subscription infos =
      bus->subscribe<rds_msgs::msg::MapInfo>("rds/map/info", bus::kLatched, [this](const auto& m) {
        const std::lock_guard lock(mutex);
        info = m;
      });
  std::unique_ptr<RunningMapper> mapper;
};

}  // namespace rds::mapper
