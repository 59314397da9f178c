// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <tl/expected.hpp>

#include "common/geometry/box.hpp"

namespace rds::evaluation {

struct PersonTruth {
  geometry::Box2 box;
  double visible_fraction = 0;
  double area_px = 0;
};
struct PeopleFrame {
  double time_s = 0;
  std::vector<PersonTruth> people;
};
/// Boxes of label "person" predicted for one frame.
struct PredictedFrame {
  double time_s = 0;
  std::vector<geometry::Box2> boxes;
};

/// Reads people.json. @return or one sentence that names the file and what was expected.
tl::expected<std::vector<PeopleFrame>, std::string> read_people(const std::filesystem::path& file);
/// Reads predictions.jsonl, sorted by time. @return or one sentence that names file, line and expectation.
tl::expected<std::vector<PredictedFrame>, std::string> read_predictions(const std::filesystem::path& file);

/// How well predicted boxes cover people; shares 0 … 1, NaN where nothing could be counted.
struct BoxScore {
  std::size_t people = 0;  // visible by more than half and larger than 2500 px of 640×480
  double recall = 0;       // share of them with a box at IoU > .5
  double mean_iou = 0;     // of the best box, 0 where none
  double cover = 0;        // mean share of the true box inside the union of the boxes
  double waste = 0;        // area of boxes that touch nobody, as a share of the image
};

/// Scores frames later than 1 s after the first; a prediction belongs to a frame less than 5 ms away.
BoxScore score_boxes(const std::vector<PeopleFrame>& truth, const std::vector<PredictedFrame>& predictions,
                     const cv::Size& picture);

}  // namespace rds::evaluation
