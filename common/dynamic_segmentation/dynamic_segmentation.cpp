// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/dynamic_segmentation.hpp"

#include <algorithm>
#include <cmath>

#include "common/dynamic_segmentation/background.hpp"
#include "common/dynamic_segmentation/box_evidence.hpp"
#include "common/dynamic_segmentation/colour_model.hpp"
#include "common/dynamic_segmentation/markov_field.hpp"

namespace rds::segmentation {
namespace {

float coupling(float depth_a_m, float depth_b_m, const geometry::DepthNoise& noise,
               const EvidenceModel& model) {
  constexpr float kSlantedFromM = 1;  // nearer, a slanted surface's steps are longer than noise
  if (depth_a_m == 0 || depth_b_m == 0) return model.hole_coupling;
  const float sigma_m = noise.sigma_m(std::max(kSlantedFromM, std::min(depth_a_m, depth_b_m)));
  const float steps = (depth_a_m - depth_b_m) / (model.step_sigmas * sigma_m);
  return model.coupling * std::exp(-steps * steps / 2);
}

Couplings couple(const cv::Mat1f& depth_m, const geometry::DepthNoise& noise, const EvidenceModel& model) {
  Couplings couplings{cv::Mat1f(depth_m.size(), 0.0F), cv::Mat1f(depth_m.size(), 0.0F)};
  for (int r = 0; r < depth_m.rows; ++r)
    for (int c = 0; c < depth_m.cols; ++c) {
      const float z = depth_m(r, c);
      if (c + 1 < depth_m.cols) couplings.right(r, c) = coupling(z, depth_m(r, c + 1), noise, model);
      if (r + 1 < depth_m.rows) couplings.below(r, c) = coupling(z, depth_m(r + 1, c), noise, model);
    }
  return couplings;
}

/// Not 0 in boxes, where something has appeared, and where something was movable: no plane is fitted there.
cv::Mat1b unknown_cells(const GridGeometry& grid, const Evidence& evidence, const EvidenceModel& model) {
  cv::Mat1b unknown = evidence.motion.appeared.empty() ? cv::Mat1b(grid.size(), std::uint8_t{0})
                                                       : evidence.motion.appeared.clone();
  for (const MovableRegion& box : evidence.boxes) unknown(cells_of(box.box_px, grid)).setTo(255);
  if (!evidence.carried.empty()) unknown.setTo(255, evidence.carried > log_odds_of(model.unseen));
  return unknown;
}

/// Adds what the background says, where a cell may yet be movable.
void add_background(const PictureCells& picture, const GridGeometry& grid, const Evidence& evidence,
                    const EvidenceModel& model, cv::Mat1f& log_odds) {
  const Background background(picture, grid, unknown_cells(grid, evidence, model));
  const float asked = log_odds_of(model.unseen);
  for (int r = 0; r < log_odds.rows; ++r)
    for (int c = 0; c < log_odds.cols; ++c) {
      float& its = log_odds(r, c);
      if (its <= asked) continue;
      if (picture.stable(r, c) != 0)
        its += model.stable;
      else if (background.shows_at({c, r}))
        its += model.plane;
    }
}

}  // namespace

float lasting_presence(float presence, double passed_s, const EvidenceModel& model) {
  const float unseen = log_odds_of(model.unseen);
  return unseen + (presence - unseen) * std::exp(-static_cast<float>(passed_s) / model.lasting_s);
}

Segmentation segment(const PictureCells& picture, const GridGeometry& grid, const Evidence& evidence,
                     const EvidenceModel& model) {
  Segmentation result{box_log_odds(picture.depth_m, grid, evidence.boxes, model), {}};
  const bool has_motion = !evidence.motion.appeared.empty();
  if (has_motion) cv::add(result.presence, model.appeared, result.presence, evidence.motion.appeared);
  if (!evidence.carried.empty())
    evidence.carried.copyTo(result.presence, evidence.carried > result.presence);
  cv::Mat1f own = result.presence.clone();
  if (has_motion) cv::add(own, model.unchanged, own, evidence.motion.unchanged);
  add_background(picture, grid, evidence, model, own);
  const Couplings couplings = couple(picture.depth_m, grid.noise(), model);
  result.log_odds = propagate(own, couplings);
  if (picture.colours.empty()) return result;
  own += colour_ratio(picture.colours, result.log_odds, model);
  result.log_odds = propagate(own, couplings);
  return result;
}

}  // namespace rds::segmentation
