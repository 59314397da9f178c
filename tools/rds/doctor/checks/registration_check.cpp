// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/registration_check.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>

namespace rds::doctor {
namespace {
constexpr double kUnscaled = 0.015;  // a scale nearer to 1 is a mere shift

std::string advice(const DepthPlacement& placement, const geometry::CameraModel& camera) {
  if (std::abs(placement.scale - 1) < kUnscaled)
    return "it is not registered to colour, or its stamps are late or early";
  return fmt::format(
      "it is probably not registered to colour; if fx {:.0f} px in camera.yaml is the depth camera's, "
      "colour's "
      "is near {:.0f} px: register depth to colour and write colour's intrinsics",
      camera.fx, 5 * std::round(placement.scale * camera.fx / 5));
}

}  // namespace

Finding check_registration(const std::optional<RegistrationFit>& fit, const geometry::CameraModel& camera) {
  if (!fit) return {Verdict::kGood, "registration", "cannot be told: too few edges in depth"};
  if (!is_misplaced(*fit, cv::Size(camera.width, camera.height)))
    return {Verdict::kGood, "registration", "depth's edges lie on colour's"};
  return {Verdict::kHint, "registration",
          fmt::format("depth fits colour best when scaled by {:.2f} about the centre and moved by ({}, {}) "
                      "px (edges agree to {:.0f} %, as it is to {:.0f} %): {}",
                      fit->best.scale, std::lround(fit->best.shift_px.x), std::lround(fit->best.shift_px.y),
                      100 * fit->agreement, 100 * fit->agreement_as_is, advice(fit->best, camera))};
}

}  // namespace rds::doctor
