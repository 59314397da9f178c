// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/geometry/transforms/transform_tree.hpp"
#include "common/image/sensors/robot_sensors.hpp"
#include "tools/recording/bag/bag.hpp"

namespace rds::recording {

/// What a bag has of a robot besides pictures: how its frames stand to each other (tf, tf_static), IMUs (Imu)
/// and odometry (nav_msgs/Odometry; without any, transforms from a frame "odom").
///
/// Frames are taken as fixed to each other, as they were told first. Of several topics of one kind those of
/// this project's names are taken, then those with "imu" or "odom" in their names, then the ones with the
/// most messages. What this project's tracker told is no robot's odometry.
class RobotTopics {
 public:
  void see(const BagTopic& topic, const BagMessage& message);

  /// @return target_from_source; nullopt if no path joins them.
  [[nodiscard]] std::optional<geometry::Pose> look_up(const std::string& target,
                                                      const std::string& source) const;
  /// Where the camera stands, and the file that sentences begin with.
  struct Place {
    std::string camera_frame;
    std::string file;
  };
  /// Those that a path joins to the camera's frame.
  /// @param notes  gets a line of each that is taken, or cannot be.
  [[nodiscard]] image::RobotSensors sensors(const Place& place, std::string& notes) const;

 private:
  struct Imu {
    std::string frame = {};
    image::ImuTrack track = {};
  };
  struct Odometry {
    std::string body = {};
    std::vector<geometry::StampedPose> poses = {};
  };
  void see_imu(const std::string& topic, const BagMessage& message);
  void see_odometry(const std::string& topic, const BagMessage& message);
  void see_transforms(const std::string& topic, const BagMessage& message);
  [[nodiscard]] std::optional<image::ImuTrack> imu(const Place& place, std::string& notes) const;
  [[nodiscard]] std::optional<image::OdometryTrack> odometry(const Place& place, std::string& notes) const;
  [[nodiscard]] const std::map<std::string, Odometry>& all_odometry() const;

  geometry::TransformTree tree_;
  std::set<std::string> placed_;     // frames with a place in the tree
  std::map<std::string, Imu> imus_;  // by topic
  std::map<std::string, Odometry> odometry_;
  std::map<std::string, Odometry> odometry_by_tf_;  // by child frame
  bool has_tracker_ = false;                        // of this project, whose transforms are in tf
};

}  // namespace rds::recording
