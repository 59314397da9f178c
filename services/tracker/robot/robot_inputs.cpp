// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/robot/robot_inputs.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace rds::tracker {
namespace {

constexpr std::size_t kMostTold = 2000;  // between two pictures: seconds of any odometry
constexpr std::size_t kMostSaid = 10;
constexpr std::chrono::milliseconds kBetweenBeats(500);
constexpr double kFirstWaitS = 1;
// Who says where the robot is, points at a map: what is told of its exactness is a lower bound.
constexpr double kLeastRadiusM = 1;
constexpr double kLeastAngleRad = 0.8;
constexpr double kSigmas = 3;

/// Of a camera that looks ahead (REP 103), where no tf says how it is mounted.
geometry::Pose body_from_optical() {
  return geometry::make_pose(Eigen::Vector3d::Zero(), Eigen::Quaterniond(-0.5, 0.5, -0.5, 0.5));
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
  if (!topics_.odometry_frame.empty()) read_transforms(context.frame(topics_.odometry_frame));
  if (!topics_.imu.empty()) read_imu(topics_.imu);
  if (!topics_.initial_pose.empty()) read_initial_poses(topics_.initial_pose);
}

void RobotInputs::take_in() {
  while (auto told = told_.try_pop()) {
    buffer_.add(told->stamp_ns, told->odom_from_body);
    body_ = std::move(told->body);
    odometry_wait_.take(*buffer_.newest_ns());
    ++context_.diagnostics.counter("odometry messages");
  }
  while (auto sensed = sensed_.try_pop()) {
    gravity_.add(sensed->measurement);
    if (sensed->has_turn_rate) turn_rates_.add(sensed->measurement.stamp_ns, sensed->measurement.turn_rate);
    imu_frame_ = std::move(sensed->frame);
    imu_wait_.take(sensed->measurement.stamp_ns);
    ++context_.diagnostics.counter("imu messages");
  }
}

bool RobotInputs::lacks_odometry(std::int64_t stamp_ns) const {
  return topics_.reads_odometry() && odometry_wait_.is_due(stamp_ns, [&] {
    return look_up_(body_, camera_frame_, stamp_ns).has_value();
  });
}

bool RobotInputs::lacks_imu(std::int64_t stamp_ns) const {
  return !topics_.imu.empty() && imu_wait_.is_due(stamp_ns, [&] {
    return look_up_(camera_frame_, imu_frame_, stamp_ns).has_value();
  });
}

void RobotInputs::go_to(std::int64_t stamp_ns, const std::string& camera_frame, const std::stop_token& stop,
                        const std::function<void()>& beat) {
  camera_frame_ = camera_frame;
  take_in();
  const bool is_first = !std::exchange(has_begun_, true);
  if (waits_s_)
    wait(stamp_ns, *waits_s_, stop, beat);
  else if (is_first)
    wait(stamp_ns, kFirstWaitS, stop, beat);
}

void RobotInputs::wait(std::int64_t stamp_ns, double limit_s, const std::stop_token& stop,
                       const std::function<void()>& beat) {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + std::chrono::duration<double>(limit_s);
  while ((lacks_odometry(stamp_ns) || lacks_imu(stamp_ns)) && !stop.stop_requested()) {
    beat();
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return give_up(stamp_ns, limit_s);
    mailbox_.wait_for(stop, std::min(left, kBetweenBeats),
                      [this] { return !told_.locked_empty() || !sensed_.locked_empty(); });
    take_in();
  }
}

void RobotInputs::give_up(std::int64_t stamp_ns, double limit_s) {
  if (waits_s_) ++context_.diagnostics.counter("lockstep timeouts");
  const auto say = [&](const std::string& what, const std::string& source) {
    spdlog::warn(
        "no {} of the frame's time, in a frame that tf joins with the camera's, has come on {} within "
        "{} s",
        what, source, limit_s);
  };
  if (lacks_odometry(stamp_ns)) {
    odometry_wait_.give_up(stamp_ns);
    say("odometry", topics_.odometry_source());
  }
  if (lacks_imu(stamp_ns)) {
    imu_wait_.give_up(stamp_ns);
    say("measurement", topics_.imu);
  }
}

std::optional<OdometryPose> RobotInputs::odometry_at(std::int64_t stamp_ns) {
  const auto found = buffer_.at(stamp_ns);
  if (!found) {
    set_fault(
        odometry_fault_,
        fmt::format("no odometry of the pictures' time comes on {}: is it published, with stamps of the "
                    "camera's clock?",
                    topics_.odometry_source()));
    return std::nullopt;
  }
  const auto body_from_camera = look_up_(body_, camera_frame_, stamp_ns);
  set_fault(odometry_fault_,
            body_from_camera
                ? ""
                : fmt::format("{} tells of a frame that no tf joins with the camera's: publish on tf_static "
                              "how the camera is mounted",
                              topics_.odometry_source()));
  if (!body_from_camera) return std::nullopt;
  return OdometryPose{found->odom_from_body, *body_from_camera, found->segment};
}

std::optional<Eigen::Vector3d> RobotInputs::up_in_camera(std::int64_t stamp_ns) const {
  const auto up_in_imu = gravity_.up(stamp_ns);
  if (!up_in_imu) return std::nullopt;
  const auto camera_from_imu = look_up_(camera_frame_, imu_frame_, stamp_ns);
  if (!camera_from_imu) return std::nullopt;
  return camera_from_imu->linear() * *up_in_imu;
}

std::optional<Eigen::Quaterniond> RobotInputs::turn_of_camera(std::int64_t from_ns, std::int64_t to_ns) {
  const auto turn_of_imu = turn_rates_.turn(from_ns, to_ns);
  if (!turn_of_imu) return std::nullopt;
  const auto mounted_before = look_up_(camera_frame_, imu_frame_, from_ns);
  const auto mounted_after = look_up_(camera_frame_, imu_frame_, to_ns);
  set_fault(imu_fault_,
            mounted_after
                ? ""
                : fmt::format("{} tells of a frame that no tf joins with the camera's: publish on tf_static "
                              "how the unit is mounted",
                              topics_.imu));
  if (!mounted_before || !mounted_after) return std::nullopt;
  return Eigen::Quaterniond(mounted_before->linear()) * *turn_of_imu *
         Eigen::Quaterniond(mounted_after->linear()).conjugate();
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
