// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/picture/map_picture_legend.hpp"

#include <opencv2/imgproc.hpp>

namespace rds::tools {
namespace {

constexpr double kTextScale = 0.55;
constexpr int kGapPx = 26;  // between entries
constexpr int kSignPx = 26;

int width_of(const std::string& text) {
  int baseline = 0;
  return cv::getTextSize(text, cv::FONT_HERSHEY_DUPLEX, kTextScale, 1, &baseline).width;
}

}  // namespace

void put_text(cv::Mat& image, const std::string& text, cv::Point at, double scale, const cv::Scalar& color,
              int thickness) {
  cv::putText(image, text, at, cv::FONT_HERSHEY_DUPLEX, scale, color, thickness, cv::LINE_AA);
}

PictureLegend::PictureLegend(cv::Mat& picture, int margin_px, int footer_px)
    : picture_(picture), x_(margin_px), y_(picture.rows - footer_px / 2) {}

void PictureLegend::line(const std::string& text, const cv::Scalar& color) {
  cv::line(picture_, {x_, y_}, {x_ + kSignPx, y_}, color, 4, cv::LINE_AA);
  put(text, kSignPx + 8);
}

void PictureLegend::dot(const std::string& text, const cv::Scalar& color) {
  cv::circle(picture_, {x_ + 7, y_}, 6, color, -1, cv::LINE_AA);
  put(text, 20);
}

void PictureLegend::square(const std::string& text, const cv::Scalar& color) {
  cv::rectangle(picture_, cv::Rect(x_, y_ - 9, 18, 18), color, -1);
  put(text, kSignPx);
}

bool PictureLegend::has_room(const std::string& text, const std::string& last) const {
  return x_ + 2 * (kSignPx + kGapPx) + width_of(text) + width_of(last) < picture_.cols;
}

void PictureLegend::put(const std::string& text, int sign_width) {
  x_ += sign_width;
  put_text(picture_, text, {x_, y_ + 6}, kTextScale, kInk);
  x_ += width_of(text) + kGapPx;
}

}  // namespace rds::tools
