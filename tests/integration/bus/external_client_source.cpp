// SPDX-License-Identifier: Apache-2.0
// Publishes what external_client.py subscribes: external_client_source fastdds|cyclonedds|zenoh DOMAIN
// SECONDS.
#include <chrono>
#include <iostream>
#include <string>
#include <thread>

#include "common/bus/participant.hpp"
#include "common/messages/conversions.hpp"
#include "common/messages/detection_conversions.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "octomap_msgs/msg/Octomap.h"
#include "tf2_msgs/msg/TFMessage.h"

namespace {

using namespace rds;

octomap_msgs::msg::Octomap make_map() {
  octomap_msgs::msg::Octomap map;
  map.header(messages::make_header(1'000'000'000, "map"));
  map.id("ColorOcTree");
  map.resolution(0.05);
  map.data().assign(200'000, 3);
  return map;
}

nav_msgs::msg::Odometry make_odometry(std::int64_t stamp_ns, int number) {
  nav_msgs::msg::Odometry odometry;
  odometry.header(messages::make_header(stamp_ns, "odom"));
  odometry.child_frame_id("camera_color_optical_frame");
  odometry.pose().pose().position().x(number);
  odometry.pose().pose().orientation().w(1);
  odometry.pose().covariance()[35] = 0.5;
  return odometry;
}

tf2_msgs::msg::TFMessage make_transforms(std::int64_t stamp_ns) {
  tf2_msgs::msg::TFMessage message;
  auto& transform = message.transforms().emplace_back();
  transform.header(messages::make_header(stamp_ns, "map"));
  transform.child_frame_id("odom");
  transform.transform().rotation().w(1);
  return message;
}

void publish(bus::Participant& participant, std::chrono::seconds duration) {
  auto odometry = participant.advertise<nav_msgs::msg::Odometry>("rds/odometry", bus::kStream);
  auto transforms = participant.advertise<tf2_msgs::msg::TFMessage>("tf", bus::kTransform);
  auto boxes = participant.advertise<vision_msgs::msg::Detection3DArray>("rds/boxes", bus::kStream);
  auto map = participant.advertise<octomap_msgs::msg::Octomap>("rds/map/full", bus::kLatched);
  map.write(make_map());
  const auto end = std::chrono::steady_clock::now() + duration;
  for (int i = 0; std::chrono::steady_clock::now() < end; ++i) {
    const std::int64_t stamp_ns = 1'000'000'000 + i * 33'333'333LL;
    geometry::OrientedBox box{geometry::Pose::Identity(), {1, 2, 2}};
    box.map_from_box.translation() = Eigen::Vector3d(0.5, 1, 2);
    const messages::SpatialDetection person{"person", 0.9F, box, std::to_string(i)};
    odometry.write(make_odometry(stamp_ns, i));
    transforms.write(make_transforms(stamp_ns));
    boxes.write(
        messages::to_detection_message(std::span(&person, 1), messages::make_header(stamp_ns, "map")));
    std::this_thread::sleep_for(std::chrono::milliseconds(33));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: external_client_source fastdds|cyclonedds|zenoh DOMAIN SECONDS\n";
    return 2;
  }
  try {
    const auto participant = bus::Participant::create({.vendor = bus::vendor_from_name(argv[1]),
                                                       .domain = std::stoi(argv[2]),
                                                       .node_name = "external_client_source",
                                                       .loopback_only = true});
    publish(*participant, std::chrono::seconds(std::stoi(argv[3])));
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
