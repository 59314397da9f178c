// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/camera_check.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

namespace rds::doctor {
namespace {
constexpr double kNarrowestDeg = 25;
constexpr double kWidestDeg = 130;
constexpr double kSquare = 0.05;  // fx off fy
constexpr double kAside = 0.15;   // of the picture's size
}  // namespace

Finding check_camera(const geometry::CameraModel& camera) {
  const double view_deg = 2 * std::atan2(camera.width, 2 * camera.fx) * 180 / std::numbers::pi;
  const auto text = fmt::format("{}×{} px, field of view {:.0f}°", camera.width, camera.height, view_deg);
  const double aside =
      std::max(std::abs(camera.cx / camera.width - 0.5), std::abs(camera.cy / camera.height - 0.5));
  std::string odd;
  if (view_deg < kNarrowestDeg || view_deg > kWidestDeg)
    odd += fmt::format("; fx {:g} px is hardly this camera's", camera.fx);
  if (std::abs(camera.fx / camera.fy - 1) > kSquare)
    odd += fmt::format("; fx {:g} and fy {:g} px: pixels are square as a rule", camera.fx, camera.fy);
  if (aside > kAside)
    odd += fmt::format("; the principal point ({:g}, {:g}) is far from the middle", camera.cx, camera.cy);
  return {odd.empty() ? Verdict::kGood : Verdict::kHint, "camera", text + odd};
}

}  // namespace rds::doctor
