// SPDX-License-Identifier: Apache-2.0
// Says `stop` when a person is within 1 m ahead of the robot, or when nobody can tell, and `go` otherwise.
// ROS_DOMAIN_ID says which domain; --loopback: this machine only, as rds run is.
//
// An example, no safety function: people whom the network does not see are not there.
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <mutex>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>

#include "common/bus/participant.hpp"
#include "common/messages/conversions.hpp"
#include "rds_msgs/msg/PredictedBoxes.h"
#include "rds_msgs/msg/TrackingState.h"

namespace {

using rds_msgs::msg::PredictedBoxes;
using rds_msgs::msg::TrackingState;

constexpr double kAheadM = 1.0;
constexpr double kHalfWidthM = 0.4;  // of the robot, with a margin
constexpr std::chrono::milliseconds kSilence{500};

/// @param low, high  of a box in the map [m].
bool is_ahead(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
              const rds::geometry::Pose& map_from_camera) {
  Eigen::AlignedBox3d box;  // around its corners, in the camera's frame: x right, z ahead
  const Eigen::AlignedBox3d in_map(low, high);
  for (int corner = 0; corner < 8; ++corner)
    box.extend(map_from_camera.inverse() *
               in_map.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  return box.max().z() > 0 && box.min().z() < kAheadM && box.max().x() > -kHalfWidthM &&
         box.min().x() < kHalfWidthM;
}

bool must_stop(const TrackingState& state, const PredictedBoxes* boxes) {
  const bool lost = state.state() == 0 || state.state() == 3;  // NOT_INITIALIZED, LOST
  const auto map_from_camera = rds::messages::to_pose(state.map_from_camera());
  if (lost || !map_from_camera || boxes == nullptr) return true;
  const auto& low = boxes->minimums();
  const auto& high = boxes->maximums();
  const std::size_t count = boxes->labels().size();
  if (low.size() != 3 * count || high.size() != 3 * count) return true;
  for (std::size_t i = 0; i < count; ++i)
    if (boxes->labels()[i] == "person" &&
        is_ahead(Eigen::Vector3d(&low[3 * i]), Eigen::Vector3d(&high[3 * i]), *map_from_camera))
      return true;
  return false;
}

/// What the threads of the bus tell the one that prints.
struct Newest {
  std::mutex mutex;
  std::condition_variable changed;
  std::shared_ptr<const TrackingState> state;
  std::shared_ptr<const PredictedBoxes> boxes;

  void take(std::shared_ptr<const PredictedBoxes> message) {
    const std::lock_guard lock(mutex);
    boxes = std::move(message);
  }
  void take(std::shared_ptr<const TrackingState> message) {
    const std::lock_guard lock(mutex);
    state = std::move(message);
    changed.notify_one();
  }
  /// Waits for the next frame.
  bool must_stop_now() {
    std::unique_lock lock(mutex);
    if (!changed.wait_for(lock, kSilence, [this] { return state != nullptr; })) return true;
    const auto frame = std::exchange(state, nullptr);
    return must_stop(*frame, boxes.get());
  }
};

}  // namespace

int main(int argc, char** argv) {
  const char* domain = std::getenv("ROS_DOMAIN_ID");
  const auto bus =
      rds::bus::Participant::create({.domain = domain != nullptr ? std::atoi(domain) : 0,
                                     .node_name = "stop",
                                     .loopback_only = argc > 1 && std::string_view(argv[1]) == "--loopback"});
  Newest newest;
  const auto take = [&](auto message) { newest.take(std::move(message)); };
  const auto boxes = bus->subscribe<PredictedBoxes>("rds/predicted_boxes", rds::bus::kStream, take);
  const auto states = bus->subscribe<TrackingState>("rds/tracking_state", rds::bus::kStream, take);
  for (std::string_view said;;) {
    const std::string_view order = newest.must_stop_now() ? "stop" : "go";
    if (order != said) std::cout << order << std::endl;
    said = order;
  }
}
