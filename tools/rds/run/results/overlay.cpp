// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/results/overlay.hpp"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "common/messages/image_conversions.hpp"

namespace rds::run {
namespace {

const cv::Scalar kKept(80, 220, 80);
const cv::Scalar kRemoved(60, 60, 240);
const cv::Scalar kUnmatched(190, 190, 190);
const cv::Scalar kBox(0, 200, 255);
const cv::Scalar kCut(70, 70, 200);
const cv::Scalar kWhite(255, 255, 255);
const cv::Scalar kBlack(0, 0, 0);

void draw_text(cv::Mat& picture, const std::string& text, cv::Point at, const cv::Scalar& color) {
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.45, kBlack, 3, cv::LINE_AA);
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.45, color, 1, cv::LINE_AA);
}

/// Tints what was cut out of the picture as movable, and outlines it.
void draw_cut(cv::Mat& picture, const sensor_msgs::msg::Image& movable) {
  constexpr double kTint = 0.35;
  const auto cells = messages::to_cell_mask(movable, picture.size());
  if (!cells || cells->empty()) return;
  cv::Mat1b cut;
  cv::resize(*cells, cut, picture.size(), 0, 0, cv::INTER_NEAREST);
  cv::Mat tinted;
  cv::addWeighted(picture, 1 - kTint, cv::Mat(picture.size(), picture.type(), kCut), kTint, 0, tinted);
  tinted.copyTo(picture, cut);
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(cut, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_SIMPLE);
  cv::drawContours(picture, outlines, -1, kCut, 1, cv::LINE_AA);
}

void draw_features(cv::Mat& picture, const rds_msgs::msg::FrameFeatures& features) {
  using rds_msgs::msg::FrameFeatures;
  const auto& positions = features.positions();
  const std::size_t count = std::min(positions.size() / 2, features.verdicts().size());
  for (std::size_t i = 0; i < count; ++i) {
    const cv::Point at(cvRound(positions[2 * i]), cvRound(positions[2 * i + 1]));
    const std::uint8_t verdict = features.verdicts()[i];
    if (verdict == 2)
      cv::drawMarker(picture, at, kRemoved, cv::MARKER_TILTED_CROSS, 6, 1, cv::LINE_AA);
    else
      cv::circle(picture, at, verdict == 1 ? 3 : 1, verdict == 1 ? kKept : kUnmatched, 1, cv::LINE_AA);
  }
}

void draw_box(cv::Mat& picture, const PredictionRecord& p) {
  const cv::Rect box(cv::Point(cvRound(p.box.x0), cvRound(p.box.y0)),
                     cv::Point(cvRound(p.box.x1), cvRound(p.box.y1)));
  cv::rectangle(picture, box, kBox, 2, cv::LINE_AA);
  draw_text(picture, fmt::format("{} {}  {:.1f} m/s", p.label, p.id, p.velocity.norm()),
            {box.x + 4, std::max(box.y + 16, 16)}, kBox);
}

}  // namespace

cv::Mat draw_overlay(const cv::Mat& bgr, const rds_msgs::msg::FrameFeatures& features,
                     const std::vector<PredictionRecord>& boxes, const FrameRecord& frame) {
  cv::Mat picture = bgr.clone();
  draw_cut(picture, features.movable());
  draw_features(picture, features);
  for (const PredictionRecord& box : boxes) draw_box(picture, box);
  draw_text(picture,
            fmt::format("{}{}  {} features, {} removed, {} inliers", frame.state,
                        frame.is_keyframe ? " keyframe" : "", frame.features, frame.dynamic_features,
                        frame.inliers),
            {8, picture.rows - 10}, kWhite);
  return picture;
}

}  // namespace rds::run
