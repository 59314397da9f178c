// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "common/concurrency/mailbox.hpp"
#include "common/service/service.hpp"
#include "services/tracker/core/level/gravity.hpp"
#include "services/tracker/core/motion/gyroscope_buffer.hpp"
#include "services/tracker/core/motion/odometry_buffer.hpp"
#include "services/tracker/core/motion/odometry_prior.hpp"
#include "services/tracker/core/relocalization/relocalizer.hpp"
#include "services/tracker/robot/inputs_config.hpp"
#include "services/tracker/robot/sensor_wait.hpp"

namespace rds::tracker {

/// What a robot senses besides pictures, as far as the settings name its topics. All but the callbacks of the
/// bus is for the worker.
class RobotInputs {
 public:
  /// @return target_from_source by tf; nullopt if no path joins the frames.
  using LookUp = std::function<std::optional<geometry::Pose>(
      const std::string& target, const std::string& source, std::int64_t stamp_ns)>;

  struct Options {
    InputsConfig topics;
    std::string base;               // frame of the robot
    std::optional<double> waits_s;  // for odometry and IMU, in lockstep; nullopt: never
  };

  RobotInputs(service::ServiceContext& context, concurrency::Mailbox& mailbox, const Options& options,
              LookUp look_up);

  /// A picture of this stamp and frame is to be tracked: takes in what has come. In lockstep it waits until
  /// odometry and IMU have come up to the stamp, and how they stand to the camera, waits_s at most
  /// (SensorWait); without lockstep for the first picture, 1 s at most, as the map begins level with it.
  /// @param beat  called now and then meanwhile.
  void go_to(std::int64_t stamp_ns, const std::string& camera_frame, const std::stop_token& stop,
             const std::function<void()>& beat);
  /// What the robot's odometry says of a time, for the tracker, with the camera's frame of go_to().
  [[nodiscard]] std::optional<OdometryPose> odometry_at(std::int64_t stamp_ns);
  /// Which way is up in the camera's frame, as long as the robot's IMU stands still.
  [[nodiscard]] std::optional<Eigen::Vector3d> up_in_camera(std::int64_t stamp_ns) const;
  /// The camera's turn between two times, earlier_from_later, by the robot's gyroscope
  /// and by how the camera has turned on the robot meanwhile.
  [[nodiscard]] std::optional<Eigen::Quaterniond> turn_of_camera(std::int64_t from_ns, std::int64_t to_ns);
  /// Where somebody has said since the last call that the camera is.
  std::optional<SoughtPlace> take_sought_place();

 private:
  struct Told {
    std::int64_t stamp_ns;
    geometry::Pose odom_from_body;
    std::string body;
  };
  struct Sensed {
    image::ImuMeasurement measurement;
    bool has_turn_rate;
    std::string frame;
  };
  struct SaidPose {
    std::int64_t stamp_ns;
    geometry::Pose map_from_base;
    double sigma_m;
    double sigma_rad;
  };
  void read_odometry(const std::string& topic);
  void read_transforms(const std::string& frame);
  void read_imu(const std::string& topic);
  void read_initial_poses(const std::string& topic);
  void take_in();
  [[nodiscard]] bool lacks_odometry(std::int64_t stamp_ns) const;
  [[nodiscard]] bool lacks_imu(std::int64_t stamp_ns) const;
  void wait(std::int64_t stamp_ns, double limit_s, const std::stop_token& stop,
            const std::function<void()>& beat);
  void give_up(std::int64_t stamp_ns, double limit_s);
  void set_fault(std::string& of, const std::string& fault);
  void warn(const std::string& name, const std::string& fault);

  service::ServiceContext& context_;
  concurrency::Mailbox& mailbox_;
  InputsConfig topics_;
  std::string base_;
  std::optional<double> waits_s_;
  LookUp look_up_;
  concurrency::Inbox<Told> told_;
  concurrency::Inbox<SaidPose> said_;
  concurrency::Inbox<Sensed> sensed_;
  OdometryBuffer buffer_;
  Gravity gravity_;
  GyroscopeBuffer turn_rates_;  // in the unit's frame
  std::string imu_frame_;
  std::string body_;
  std::string camera_frame_;
  bool has_begun_ = false;  // there was a picture
  SensorWait odometry_wait_;
  SensorWait imu_wait_;
  mutable std::mutex mutex_;  // of the faults
  std::string odometry_fault_;
  std::string imu_fault_;
  std::vector<bus::Subscription> subscriptions_;  // last: callbacks use the members above
};

}  // namespace rds::tracker
