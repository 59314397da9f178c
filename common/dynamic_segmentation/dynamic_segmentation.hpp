// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/dynamic_segmentation/background.hpp"
#include "common/dynamic_segmentation/evidence_model.hpp"
#include "common/dynamic_segmentation/motion_evidence.hpp"
#include "common/dynamic_segmentation/object_region.hpp"

namespace rds::segmentation {

/// What is known of a picture, besides its depth. All of the grid's size, or empty where nothing is known.
struct Evidence {
  std::span<const ObjectRegion> boxes;
  MotionEvidence motion;
  cv::Mat1f carried;  // Segmentation::presence of earlier pictures, where the same surfaces show
};

/// Of each cell log(P(movable) / P(static)).
struct Segmentation {
  cv::Mat1f presence;  // by what tells of movable things only, each cell for itself
  cv::Mat1f log_odds;  // by all that is known, neighbours included; above 0 what is more likely movable
  std::vector<BackgroundPlane> planes;  // that go on outside what may be movable
};

/// What of a picture is movable, as EvidenceModel says. The same evidence gives the same bytes.
Segmentation segment(const PictureCells& picture, const GridGeometry& grid, const Evidence& evidence,
                     const EvidenceModel& model = {});

/// Presence that a surface keeps after that time without further evidence.
float lasting_presence(float presence, double passed_s, const EvidenceModel& model = {});

}  // namespace rds::segmentation
