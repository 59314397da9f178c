// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <numbers>
#include <optional>
#include <string_view>

namespace rds::geometry {

/// How well a depth camera measures: standard deviations at depth z of a surface that faces it.
///
///     along the optical axis   σ_z(z) = a + b · max(0, z − c)²   [m]
///     across it                σ_L                               [px]
///
/// A camera that triangulates (stereo, structured light) has b = σ_d / (f·B) and a = c = 0: the disparity
/// f·B/z has the same σ_d at all depths (Khoshelham & Elberink 2012, eq. 10). A table: depth_noise().
struct DepthNoise {
  std::string_view name;    // in settings
  double least_m = 0;       // a
  double growth_per_m = 0;  // b
  double from_m = 0;        // c
  double lateral_px = 0;    // σ_L

  template <std::floating_point Number>
  [[nodiscard]] constexpr Number sigma_m(Number depth_m) const {
    const Number beyond = std::max(Number(0), depth_m - static_cast<Number>(from_m));
    return static_cast<Number>(least_m) + static_cast<Number>(growth_per_m) * beyond * beyond;
  }
  /// How far two measurements at this depth differ at most if what they measure is as far: 3 σ of a
  /// difference, which one pair in 370 exceeds.
  template <std::floating_point Number>
  [[nodiscard]] constexpr Number difference_m(Number depth_m) const {
    return static_cast<Number>(3 * std::numbers::sqrt2) * sigma_m(depth_m);
  }
  /// How far from its plane a point of a wall, a floor or a table top is measured at most: 3 σ, which one in
  /// 370 exceeds, and the relief that such surfaces have.
  template <std::floating_point Number>
  [[nodiscard]] constexpr Number plane_tolerance_m(Number depth_m) const {
    constexpr auto kReliefM = static_cast<Number>(.012);
    return kReliefM + 3 * sigma_m(depth_m);
  }

  constexpr bool operator==(const DepthNoise&) const = default;
};

/// A camera that triangulates. @param disparity_sigma_px  σ_d, at that focal length.
constexpr DepthNoise triangulating(std::string_view name, double disparity_sigma_px, double focal_length_px,
                                   double baseline_m, double lateral_px) {
  return {name, 0, disparity_sigma_px / (focal_length_px * baseline_m), 0, lateral_px};
}

/// A Kinect's disparities, PrimeSense's: ½ of a step of ⅛ px at random, and the rounding to steps (step / √12).
/// Source: Khoshelham & Elberink 2012, §4: f = 586 px, B = 75 mm, m/(f·B) = 2.85e-5 / cm, σ_d' = ½.
inline constexpr double kPrimeSenseDisparityPx = 0.0722;

/// The first is the default.
inline constexpr std::array kDepthNoises{
    // σ_L: Nguyen, Izadi & Lovell 2012, eq. 1. Their σ_z (eq. 3), .0012 + .0019 (z − .4)² m, is the same from
    // 1 m on to an eighth.
    triangulating("kinect_v1", kPrimeSenseDisparityPx, 586, .075, .8),
    // The Kinect's chip and baseline.
    triangulating("xtion", kPrimeSenseDisparityPx, 586, .075, .8),
    // D435 at 848×480: Intel, "Best-known methods for tuning D400 depth cameras": RMS = z²·subpixel/(f·B),
    // .08 px on a textured surface. σ_L not published; it matches windows, too.
    triangulating("realsense", .08, 424, .05, .8),
    // Fankhauser et al. 2015, Kinect v2: 1.5 − .5 z + .3 z² mm, across 1.6 mm (.5 px of 504 px at 1.6 m).
    // The Azure Kinect's own: at most 17 mm up to 3.86 m (Microsoft), confirmed by Tölgyessy et al. 2021.
    DepthNoise{"azure_kinect", .0013, .0003, .83, .5},
    // Astra: structured light as PrimeSense's, 570 px, 75 mm. Gemini: realsense; Femto: azure_kinect.
    triangulating("orbbec", kPrimeSenseDisparityPx, 570, .075, .8),
    // A rendering: rounded to whole millimetres and pixels, 1/√12 of them.
    DepthNoise{"ideal", .00029, 0, 0, .29}};

/// nullopt if there is none of that name.
[[nodiscard]] constexpr std::optional<DepthNoise> depth_noise(std::string_view name) {
  const auto* const found = std::ranges::find(kDepthNoises, name, &DepthNoise::name);
  return found == kDepthNoises.end() ? std::nullopt : std::optional(*found);
}

}  // namespace rds::geometry
