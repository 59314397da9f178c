// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace rds::segmentation {

/// What is known of how movable things show in a picture: probabilities, natural logarithms of likelihood
/// ratios P(evidence | movable) / P(evidence | static), and lengths. Fitted to the masks of three recordings
/// (README.md).
struct EvidenceModel {
  // A cell is movable with this probability …
  float unseen = 0.1F;  // where no box is: people come before their boxes do
  float filled = 0.8F;  // in a box, at the depth of its object
  // … and these ratios are added.
  float appeared = 10;      // nearer than what stood there before
  float unchanged = -1.2F;  // the same surface as before
  float plane = -1.5F;      // on a plane that goes on outside the boxes
  float stable = -3;        // at a point that has stood in its place for long
  float lasting_s = 1;      // what was known of a surface loses 1/e of its weight in this time
  // Neighbours are of one thing unless depth steps between them.
  float coupling = 20;       // log of how much likelier two cells of one surface are alike
  float hole_coupling = 4;   // the same, with a cell whose depth was not measured
  float step_sigmas = 7;     // standard deviation of a (slanted) surface's steps, in those of depth
  // A cell's colour counts as the logarithm of its share of what is movable and of the rest.
  float colour_weight = 3;
  float colour_prior = 0.03F;  // cells that each colour has on either side before any is counted
};

inline float log_odds_of(float probability) {
  return std::log(probability / (1 - probability));
}

}  // namespace rds::segmentation
