// SPDX-License-Identifier: Apache-2.0
#include "common/image/sensors/odometry_file.hpp"

#include <utility>

#include <fmt/format.h>

namespace rds::image {

tl::expected<OdometryTrack, std::string> read_odometry(const std::filesystem::path& file) {
  auto poses = geometry::read_trajectory(file);
  if (!poses) return tl::unexpected(poses.error());
  if (poses->empty()) return tl::unexpected(fmt::format("{}: expected at least one pose", file.string()));
  return OdometryTrack{.odom_from_body = std::move(*poses)};
}

}  // namespace rds::image
