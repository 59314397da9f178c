// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/input/pose_file.hpp"

#include <cmath>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include "common/geometry/trajectory.hpp"

namespace rds::tracker {

GivenPoses read_given_poses(const std::filesystem::path& file, double max_gap_s) {
  if (file.empty()) return {};
  auto read = geometry::read_trajectory(file);
  if (!read) throw std::runtime_error(read.error());
  if (read->empty()) throw std::runtime_error(fmt::format("{}: expected at least one pose", file.string()));
  const auto poses = std::make_shared<const std::vector<geometry::StampedPose>>(std::move(*read));
  const auto max_gap_ns = std::llround(max_gap_s * 1e9);
  return
      [poses, max_gap_ns](std::int64_t stamp_ns) { return geometry::pose_at(*poses, stamp_ns, max_gap_ns); };
}

}  // namespace rds::tracker
