// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "services/tracker/core/features/image_pyramid.hpp"

namespace rds::tracker {

/// A patch of a reference picture and how it shows in another.
struct PatchWarp {
  const ImagePyramid* reference = nullptr;
  Eigen::Vector2f reference_px = Eigen::Vector2f::Zero();                // in the reference picture
  Eigen::Matrix2f picture_from_reference = Eigen::Matrix2f::Identity();  // of small displacements
  double scale = 1;  // of the feature in the reference picture: how many of its pixels are one of the patch
};

struct AlignedPatch {
  Eigen::Vector2f image_px = Eigen::Vector2f::Zero();
  float correlation = 0;  // −1 … 1, of the two patches
};

/// Finds, to a fraction of a pixel, where a picture shows a patch of another one.
///
/// Inverse compositional Lucas–Kanade on 8×8 pixels, whatever their brightness and contrast, at the level
/// where a pixel is as large as the feature.
/// Source: Forster, Pizzoli & Scaramuzza 2014 (SVO), §IV-B; Baker & Matthews 2004.
/// @param expected_px  where to start, in the picture.
/// @param max_shift    pixels of that level that the place may be away from there.
/// @return nullopt if the patch shows no corner, reaches out of a picture, is too much scaled, or does not
/// converge.
std::optional<AlignedPatch> align_feature(const PatchWarp& warp, const ImagePyramid& picture,
                                          const Eigen::Vector2f& expected_px, double max_shift);

}  // namespace rds::tracker
