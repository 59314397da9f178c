// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rds::tracker {

/// ORB extraction.
struct ExtractionConfig {
  int features = 1000;         // wanted per picture
  int levels = 8;              // of the pyramid
  double scale_factor = 1.2;   // between levels
  int fast_threshold = 20;     // grey levels
  int fast_threshold_low = 7;  // where a cell shows no corner with the first
  int cell_px = 30;            // side of such a cell
  double starved_share =
      0.3;  // with fewer static features than this share of the wanted, movable ones may match
  bool operator==(const ExtractionConfig&) const = default;
};

}  // namespace rds::tracker
