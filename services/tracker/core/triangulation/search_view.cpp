// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/triangulation/search_view.hpp"

#include "services/tracker/core/motion/se3.hpp"

namespace rds::tracker {

void SearchView::list_free() {
  for (std::uint32_t i = 0; i < taken.size(); ++i)
    if (taken[i] == kNoId) free.push_back({i, ray(i)});
}

PointView SearchView::see(std::uint32_t i, const ScalePyramid& pyramid) const {
  return {se3_exp(moved(i)) * camera_from_map, model, model.measurement(feature(i), pyramid)};
}

/// The camera's motion between the middle row and the feature's that the feature is not compensated for.
Twist SearchView::moved(std::uint32_t i) const {
  Twist compensated = motion.velocity;
  if (!(feature(i).depth_m > 0)) compensated.head<3>().setZero();
  return row_share(features.camera(), static_cast<double>(feature(i).image_px.y())) *
         (readout_s * motion.velocity - motion.readout_s * compensated);
}

Eigen::Vector3d SearchView::ray(std::uint32_t i) const {
  const Eigen::Vector3d seen = model.ray(feature(i).px.cast<double>());
  const Eigen::Vector3d there = seen - moved(i).tail<3>().cross(seen);
  return there / there.z();
}

}  // namespace rds::tracker
