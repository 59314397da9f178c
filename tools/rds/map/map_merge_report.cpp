// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include <fmt/format.h>

#include "tools/rds/map/map_merge.hpp"

namespace rds::tools {
namespace {

constexpr double kMmPerM = 1000;

double degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

std::string count(std::size_t n, const char* one) {
  return fmt::format("{} {}{}", n, one, n == 1 ? "" : "s");
}

}  // namespace

std::string describe(const MergeReport& report) {
  const tracker::MapJoint& joint = report.joint;
  const Eigen::Vector3d at = joint.earlier_from_later.translation();
  std::string text = fmt::format(
      "Of {} of {} {} were found in {}, and {} of these lie where they were found, to {:.1f} mm and {:.2f} "
      "deg "
      "(median), by {} matches.\n",
      count(joint.searched, "keyframe"), report.later, joint.found, report.earlier, joint.agreeing,
      kMmPerM * joint.residual_m, degrees(joint.residual_rad), joint.inliers);
  text += fmt::format("The origin of {} lies at {:.3f} {:.3f} {:.3f} m in {}, turned by {:.2f} deg.\n",
                      report.later, at.x(), at.y(), at.z(), report.earlier,
                      degrees(geometry::rotation_angle_rad(joint.earlier_from_later.linear())));
  text += fmt::format("{} of both are one; the map has {} and {}.\n", count(joint.fused, "map point"),
                      count(report.keyframes, "keyframe"), count(report.points, "map point"));
  text += fmt::format("{} are occupied that were not in {}, {} that were are not.\n",
                      count(report.voxels.appeared, "voxel"), report.earlier, report.voxels.vanished);
  text += fmt::format("{} of both are one, {} of {} have gone; the map has {}.\n",
                      count(report.common_objects, "object"), report.gone_objects, report.earlier,
                      count(report.objects, "object"));
  for (const std::string& map : report.without_loop_closer)
    text += fmt::format("{} was saved without the loop closer's part: no loop is closed to its keyframes.\n",
                        map);
  return text;
}

nlohmann::ordered_json to_json(const MergeReport& report) {
  const tracker::MapJoint& joint = report.joint;
  const Eigen::Vector3d at = joint.earlier_from_later.translation();
  const Eigen::Quaterniond turned(joint.earlier_from_later.linear());
  return {{"searched", joint.searched},
          {"found", joint.found},
          {"agreeing", joint.agreeing},
          {"inliers", joint.inliers},
          {"residual_m", joint.residual_m},
          {"residual_deg", degrees(joint.residual_rad)},
          {"a_from_b", {at.x(), at.y(), at.z(), turned.x(), turned.y(), turned.z(), turned.w()}},
          {"fused_points", joint.fused},
          {"keyframes", report.keyframes},
          {"points", report.points},
          {"voxels_appeared", report.voxels.appeared},
          {"voxels_vanished", report.voxels.vanished},
          {"objects", report.objects},
          {"common_objects", report.common_objects},
          {"gone_objects", report.gone_objects},
          {"without_loop_closer", report.without_loop_closer}};
}

}  // namespace rds::tools
