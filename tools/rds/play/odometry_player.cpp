// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/play/odometry_player.hpp"

#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "common/topics/endpoints.hpp"
#include "tools/recording/camera_messages.hpp"

namespace rds::play {
namespace {

std::vector<geometry::StampedPose> read(const std::filesystem::path& file) {
  auto poses = geometry::read_trajectory(file);
  if (!poses) throw std::runtime_error(poses.error());
  if (poses->empty()) throw std::runtime_error(fmt::format("{}: expected at least one pose", file.string()));
  return std::move(*poses);
}

}  // namespace

OdometryPlayer::OdometryPlayer(bus::Participant& bus, const std::filesystem::path& file)
    : poses_(read(file)), publisher_(topics::advertise(bus, topics::kRobotOdometry, topics::kPlayer)) {}

void OdometryPlayer::publish_through(std::int64_t stamp_ns, std::int64_t shift_ns) {
  if (std::exchange(shift_ns_, shift_ns) != shift_ns) next_ = 0;
  for (bool is_through = next_ > 0 && poses_[next_ - 1].stamp_ns >= stamp_ns;
       !is_through && next_ < poses_.size(); ++next_) {
    const geometry::StampedPose& pose = poses_[next_];
    publisher_.write(recording::odometry_message(pose.map_from_camera, pose.stamp_ns + shift_ns));
    is_through = pose.stamp_ns >= stamp_ns;
  }
}

}  // namespace rds::play
