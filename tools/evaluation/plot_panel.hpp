// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace rds::evaluation {

/// An interval of data values, low < high.
struct PlotRange {
  double low = 0;
  double high = 1;
};

/// The smallest range around values, widened by 5 % on both sides; [0, 1] around nothing.
PlotRange range_around(const std::vector<double>& values);

/// A rectangle of a picture with axes, in which lines of data are drawn.
class PlotPanel {
 public:
  /// @param canvas  CV_8UC3, kept and drawn into.
  /// @param area  of the data [px]; tick labels and titles stand outside of it.
  /// @param equal_scale  widens one range so that a metre is as long in x as in y.
  PlotPanel(cv::Mat& canvas, cv::Rect area, PlotRange x, PlotRange y, bool equal_scale);

  void draw_axes(const std::string& x_title, const std::string& y_title);
  void draw_line(const std::vector<cv::Point2d>& points, const cv::Scalar& color, int thickness);
  void draw_dot(const cv::Point2d& point, const cv::Scalar& color);
  /// Line samples with names in the top left corner, one below the other.
  void draw_legend_entry(int row, const std::string& name, const cv::Scalar& color);

 private:
  [[nodiscard]] cv::Point2d to_pixel(const cv::Point2d& data) const;

  cv::Mat canvas_;
  cv::Rect area_;
  PlotRange x_;
  PlotRange y_;
};

/// Text with its left, centre or right end at x; `baseline` is its lower edge [px].
enum class TextAnchor { kLeft, kCenter, kRight };
void draw_text(cv::Mat& canvas, const std::string& text, cv::Point baseline, TextAnchor anchor,
               double scale = 0.45);

}  // namespace rds::evaluation
