// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/couplings.hpp"

#include <algorithm>

#include "common/dynamic_segmentation/cell_rows.hpp"

namespace rds::segmentation {
namespace {

/// What a cell measures, and its standard deviation, which grows with it.
struct Depths {
  cv::Mat1f depth_m;
  cv::Mat1f sigma_m;

  [[nodiscard]] Depths in(const cv::Rect& cells) const { return {depth_m(cells), sigma_m(cells)}; }
};

cv::Mat1f sigmas(const cv::Mat1f& depth_m, const geometry::DepthNoise& noise) {
  constexpr float kSlantedFromM = 1;  // nearer, a slanted surface's steps are longer than noise
  cv::Mat1f sigma_m(depth_m.size());
  std::transform(depth_m.begin(), depth_m.end(), sigma_m.begin(),
                 [&](float z) { return noise.sigma_m(std::max(kSlantedFromM, z)); });
  return sigma_m;
}

void couple(const Depths& cells, const Depths& neighbours, const EvidenceModel& model, cv::Mat1f couplings) {
  for (int r = 0; r < couplings.rows; ++r) {
    const auto a = row_of(cells.depth_m, r);
    const auto b = row_of(neighbours.depth_m, r);
    const auto sigma_m = row_of(cells.sigma_m, r).min(row_of(neighbours.sigma_m, r));
    const auto steps = (a - b) / (model.step_sigmas * sigma_m);
    auto its = row_of(couplings, r);
    its = model.coupling * (-0.5F * steps.square()).exp();
    its = (a > 0 && b > 0).select(its, model.hole_coupling);
  }
}

}  // namespace

Couplings couple(const cv::Mat1f& depth_m, const geometry::DepthNoise& noise, const EvidenceModel& model) {
  const Depths all{depth_m, sigmas(depth_m, noise)};
  Couplings couplings{cv::Mat1f(depth_m.size(), 0.0F), cv::Mat1f(depth_m.size(), 0.0F)};
  const cv::Rect left(0, 0, depth_m.cols - 1, depth_m.rows);
  const cv::Rect upper(0, 0, depth_m.cols, depth_m.rows - 1);
  couple(all.in(left), all.in(left + cv::Point(1, 0)), model, couplings.right(left));
  couple(all.in(upper), all.in(upper + cv::Point(0, 1)), model, couplings.below(upper));
  return couplings;
}

}  // namespace rds::segmentation
