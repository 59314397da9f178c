// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/robot/robot_inputs.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "common/messages/conversions.hpp"
#include "common/topics/endpoints.hpp"
#include "geometry_msgs/msg/PoseWithCovarianceStamped.h"
#include "nav_msgs/msg/Odometry.h"
#include "sensor_msgs/msg/Imu.h"

namespace rds::tracker {
namespace {

constexpr std::size_t kMostTold = 2000;  // between two pictures: seconds of any odometry
constexpr std::size_t kMostSaid = 10;
constexpr std::chrono::milliseconds kBetweenBeats(500);
// Who says where the robot is, points at a map: what is told of its exactness is a lower bound.
constexpr double kLeastRadiusM = 1;
constexpr double kLeastAngleRad = 0.8;
constexpr double kSigmas = 3;
constexpr double kNotMeasured = -1;  // first of a covariance, of what an Imu has no sensor for
// In the rows of a covariance: x, y, z, then the angles about them.
constexpr std::size_t kXX = 0;
constexpr std::size_t kYY = 7;
constexpr std::size_t kYawYaw = 35;

/// Of a camera that looks ahead (REP 103), where no tf says how it is mounted.
geometry::Pose body_from_optical() {
  return geometry::make_pose(Eigen::Vector3d::Zero(), Eigen::Quaterniond(-0.5, 0.5, -0.5, 0.5));
}

double sigma_of(double variance) {
  return std::isfinite(variance) && variance > 0 ? std::sqrt(variance) : 0;
}

}  // namespace

RobotInputs::RobotInputs(service::ServiceContext& context, concurrency::Mailbox& mailbox,
                         const Options& options, LookUp look_up)
    : context_(context),
      mailbox_(mailbox),
      topics_(options.topics),
      base_(context.frame(options.base)),
      waits_s_(options.waits_s),
      look_up_(std::move(look_up)),
      told_(mailbox, kMostTold),
      said_(mailbox, kMostSaid),
      sensed_(mailbox, kMostTold) {
  if (!topics_.odometry.empty()) read_odometry(topics_.odometry);
  if (!topics_.imu.empty()) read_imu(topics_.imu);
  if (!topics_.initial_pose.empty()) read_initial_poses(topics_.initial_pose);
}

void RobotInputs::read_odometry(const std::string& topic) {
  const auto take = [this](const std::shared_ptr<const nav_msgs::msg::Odometry>& m) {
    const auto pose = messages::to_pose(m->pose().pose());
    if (!pose)
      return context_.diagnostics.reject(topics::kRobotOdometry.name, service::Rejection::kInvalid,
                                         pose.error());
    told_.push({messages::to_nanoseconds(m->header().stamp()), *pose, m->child_frame_id()});
  };
  subscriptions_.push_back(
      topics::subscribe(context_.bus, topics::kRobotOdometry.named(topic), topics::kTracker, take));
  warn("odometry", odometry_fault_);
}

/// @param fault  read under the lock.
void RobotInputs::warn(const std::string& name, const std::string& fault) {
  context_.diagnostics.warning(name, [this, &fault]() -> std::optional<std::string> {
    const std::lock_guard lock(mutex_);
    return fault.empty() ? std::nullopt : std::optional(fault);
  });
}

void RobotInputs::read_imu(const std::string& topic) {
  const auto take = [this](const std::shared_ptr<const sensor_msgs::msg::Imu>& m) {
    const auto& a = m->linear_acceleration();
    const auto& w = m->angular_velocity();
    sensed_.push(
        {{messages::to_nanoseconds(m->header().stamp()), {a.x(), a.y(), a.z()}, {w.x(), w.y(), w.z()}},
         m->angular_velocity_covariance()[0] != kNotMeasured,
         m->header().frame_id()});
  };
  warn("imu", imu_fault_);
  subscriptions_.push_back(
      topics::subscribe(context_.bus, topics::kImu.named(topic), topics::kTracker, take));
}

void RobotInputs::read_initial_poses(const std::string& topic) {
  using Message = geometry_msgs::msg::PoseWithCovarianceStamped;
  const auto take = [this, map = context_.frame("map")](const std::shared_ptr<const Message>& m) {
    const auto refuse = [&](const std::string& why) {
      context_.diagnostics.reject(topics::kInitialPose.name, service::Rejection::kInvalid, why);
    };
    const auto pose = messages::to_pose(m->pose().pose());
    if (!pose) return refuse(pose.error());
    if (m->header().frame_id() != map) return refuse(fmt::format("expected a pose in {}", map));
    const auto& covariance = m->pose().covariance();
    said_.push({messages::to_nanoseconds(m->header().stamp()), *pose,
                sigma_of(std::max(covariance[kXX], covariance[kYY])), sigma_of(covariance[kYawYaw])});
  };
  subscriptions_.push_back(
      topics::subscribe(context_.bus, topics::kInitialPose.named(topic), topics::kTracker, take));
}

void RobotInputs::take_in() {
  while (auto told = told_.try_pop()) {
    buffer_.add(told->stamp_ns, told->odom_from_body);
    body_ = std::move(told->body);
    ++context_.diagnostics.counter("odometry messages");
  }
  while (auto sensed = sensed_.try_pop()) {
    gravity_.add(sensed->measurement);
    if (sensed->has_turn_rate) turn_rates_.add(sensed->measurement.stamp_ns, sensed->measurement.turn_rate);
    imu_frame_ = std::move(sensed->frame);
    ++context_.diagnostics.counter("imu messages");
  }
}

bool RobotInputs::has_odometry_at(std::int64_t stamp_ns) const {
  const auto newest = buffer_.newest_ns();
  return newest && *newest >= stamp_ns;
}

void RobotInputs::go_to(std::int64_t stamp_ns, const std::string& camera_frame, const std::stop_token& stop,
                        const std::function<void()>& beat) {
  using Clock = std::chrono::steady_clock;
  camera_frame_ = camera_frame;
  take_in();
  if (!waits_s_ || topics_.odometry.empty()) return;
  if (waited_in_vain_ && buffer_.newest_ns() == newest_in_vain_) return;
  waited_in_vain_ = false;
  const auto deadline = Clock::now() + std::chrono::duration<double>(*waits_s_);
  while (!has_odometry_at(stamp_ns) && !stop.stop_requested()) {
    beat();
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) {
      waited_in_vain_ = true;
      newest_in_vain_ = buffer_.newest_ns();
      ++context_.diagnostics.counter("lockstep timeouts");
      return spdlog::warn("no odometry of the frame's time has come on {} within {} s", topics_.odometry,
                          *waits_s_);
    }
    mailbox_.wait_for(stop, std::min(left, kBetweenBeats), [this] { return !told_.locked_empty(); });
    take_in();
  }
}

std::optional<OdometryPose> RobotInputs::odometry_at(std::int64_t stamp_ns) {
  const auto found = buffer_.at(stamp_ns);
  if (!found) {
    set_fault(
        odometry_fault_,
        fmt::format("no odometry of the pictures' time comes on {}: is it published, with stamps of the "
                    "camera's clock?",
                    topics_.odometry));
    return std::nullopt;
  }
  const auto body_from_camera = look_up_(body_, camera_frame_, stamp_ns);
  set_fault(odometry_fault_,
            body_from_camera
                ? ""
                : fmt::format("{} tells of a frame that no tf joins with the camera's: publish on tf_static "
                              "how the camera is mounted",
                              topics_.odometry));
  if (!body_from_camera) return std::nullopt;
  return OdometryPose{found->odom_from_body, *body_from_camera, found->segment};
}

std::optional<Eigen::Vector3d> RobotInputs::up_in_camera(std::int64_t stamp_ns) const {
  const auto up_in_imu = gravity_.up();
  if (!up_in_imu) return std::nullopt;
  const auto camera_from_imu = look_up_(camera_frame_, imu_frame_, stamp_ns);
  if (!camera_from_imu) return std::nullopt;
  return camera_from_imu->linear() * *up_in_imu;
}

std::optional<Eigen::Quaterniond> RobotInputs::turn_of_camera(std::int64_t from_ns, std::int64_t to_ns) {
  const auto turn_of_imu = turn_rates_.turn(from_ns, to_ns);
  if (!turn_of_imu) return std::nullopt;
  const auto camera_from_imu = look_up_(camera_frame_, imu_frame_, to_ns);
  set_fault(imu_fault_,
            camera_from_imu
                ? ""
                : fmt::format("{} tells of a frame that no tf joins with the camera's: publish on tf_static "
                              "how the unit is mounted",
                              topics_.imu));
  if (!camera_from_imu) return std::nullopt;
  const Eigen::Quaterniond mounting(camera_from_imu->linear());
  return mounting * *turn_of_imu * mounting.conjugate();
}

void RobotInputs::set_fault(std::string& of, const std::string& fault) {
  const std::lock_guard lock(mutex_);
  of = fault;
}

std::optional<SoughtPlace> RobotInputs::take_sought_place() {
  std::optional<SaidPose> newest;
  while (auto said = said_.try_pop()) newest = said;
  if (!newest) return std::nullopt;
  const auto base_from_camera = look_up_(base_, camera_frame_, newest->stamp_ns);
  return SoughtPlace{newest->map_from_base * base_from_camera.value_or(body_from_optical()),
                     std::max(kLeastRadiusM, kSigmas * newest->sigma_m),
                     std::max(kLeastAngleRad, kSigmas * newest->sigma_rad)};
}

}  // namespace rds::tracker
