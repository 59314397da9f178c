// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/dynamic_segmentation.hpp"

#include <cmath>

#include "common/dynamic_segmentation/box_evidence.hpp"
#include "common/dynamic_segmentation/colour_model.hpp"
#include "common/dynamic_segmentation/couplings.hpp"

namespace rds::segmentation {
namespace {

/// Not 0 in boxes, where something has appeared, and where something was movable: no plane is fitted there.
cv::Mat1b unknown_cells(const GridGeometry& grid, const Evidence& evidence, const EvidenceModel& model) {
  cv::Mat1b unknown = evidence.motion.appeared.empty() ? cv::Mat1b(grid.size(), std::uint8_t{0})
                                                       : evidence.motion.appeared.clone();
  for (const ObjectRegion& box : evidence.boxes) unknown(cells_of(box.box_px, grid)).setTo(255);
  if (!evidence.carried.empty()) unknown.setTo(255, evidence.carried > log_odds_of(model.unseen));
  return unknown;
}

/// Adds what the background says, where a cell may yet be movable.
void add_background(const PictureCells& picture, const Background& background, const EvidenceModel& model,
                    cv::Mat1f& log_odds) {
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
  Segmentation result{box_log_odds(picture.depth_m, grid, evidence.boxes, model),
                      {},
                      background_planes(picture, grid, unknown_cells(grid, evidence, model))};
  const bool has_motion = !evidence.motion.appeared.empty();
  if (has_motion) cv::add(result.presence, model.appeared, result.presence, evidence.motion.appeared);
  if (!evidence.carried.empty())
    evidence.carried.copyTo(result.presence, evidence.carried > result.presence);
  cv::Mat1f own = result.presence.clone();
  if (has_motion) cv::add(own, model.unchanged, own, evidence.motion.unchanged);
  add_background(picture, Background(picture.depth_m, grid, result.planes), model, own);
  const Couplings couplings = couple(picture.depth_m, grid.noise(), model);
  result.log_odds = propagate(own, couplings);
  if (picture.colours.empty()) return result;
  own += colour_ratio(picture.colours, result.log_odds, model);
  result.log_odds = propagate(own, couplings);
  return result;
}

}  // namespace rds::segmentation
