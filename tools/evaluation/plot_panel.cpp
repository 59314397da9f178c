// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/plot_panel.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace rds::evaluation {
namespace {
const cv::Scalar kInk(60, 60, 60);
const cv::Scalar kGrid(225, 225, 225);
constexpr double kMargin = 0.05;
constexpr double kSmallestSpan = 1e-3;
constexpr int kTicks = 6;
constexpr int kSubpixelBits = 4;
constexpr double kPixelLimit = 1e5;

/// 1, 2 or 5 times a power of ten, so that about kTicks of them fit.
double tick_step(const PlotRange& range) {
  const double raw = (range.high - range.low) / kTicks;
  const double power = std::pow(10, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (raw <= factor * power) return factor * power;
  return 10 * power;
}

std::vector<double> ticks_of(const PlotRange& range) {
  const double step = tick_step(range);
  std::vector<double> ticks;
  for (double index = std::ceil(range.low / step); index * step <= range.high; ++index)
    ticks.push_back(index * step);
  return ticks;
}

std::string tick_label(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
  return fmt::format("{:.{}f}", value == 0 ? 0.0 : value, decimals);
}

void widen(PlotRange& range, double factor) {
  const double center = (range.low + range.high) / 2;
  const double half = (range.high - range.low) / 2 * factor;
  range = {center - half, center + half};
}

cv::Point fixed_point(const cv::Point2d& pixel) {
  const auto coordinate = [](double v) {
    return static_cast<int>(std::lround(std::clamp(v, -kPixelLimit, kPixelLimit) * (1 << kSubpixelBits)));
  };
  return {coordinate(pixel.x), coordinate(pixel.y)};
}

}  // namespace

PlotRange range_around(const std::vector<double>& values) {
  if (values.empty()) return {};
  const auto [low, high] = std::ranges::minmax(values);
  PlotRange range{low, std::max(high, low + kSmallestSpan)};
  widen(range, 1 + 2 * kMargin);
  return range;
}

PlotPanel::PlotPanel(cv::Mat& canvas, cv::Rect area, PlotRange x, PlotRange y, bool equal_scale)
    : canvas_(canvas), area_(area), x_(x), y_(y) {
  if (!equal_scale) return;
  const double x_metres_per_px = (x.high - x.low) / area.width;
  const double y_metres_per_px = (y.high - y.low) / area.height;
  const double metres_per_px = std::max(x_metres_per_px, y_metres_per_px);
  widen(x_, metres_per_px / x_metres_per_px);
  widen(y_, metres_per_px / y_metres_per_px);
}

cv::Point2d PlotPanel::to_pixel(const cv::Point2d& data) const {
  return {area_.x + (data.x - x_.low) / (x_.high - x_.low) * area_.width,
          area_.y + area_.height - (data.y - y_.low) / (y_.high - y_.low) * area_.height};
}

void PlotPanel::draw_axes(const std::string& x_title, const std::string& y_title) {
  const int bottom = area_.y + area_.height;
  for (const double tick : ticks_of(x_)) {
    const int x = static_cast<int>(std::lround(to_pixel({tick, y_.low}).x));
    cv::line(canvas_, {x, area_.y}, {x, bottom}, kGrid);
    draw_text(canvas_, tick_label(tick, tick_step(x_)), {x, bottom + 18}, TextAnchor::kCenter);
  }
  for (const double tick : ticks_of(y_)) {
    const int y = static_cast<int>(std::lround(to_pixel({x_.low, tick}).y));
    cv::line(canvas_, {area_.x, y}, {area_.x + area_.width, y}, kGrid);
    draw_text(canvas_, tick_label(tick, tick_step(y_)), {area_.x - 6, y + 5}, TextAnchor::kRight);
  }
  cv::rectangle(canvas_, area_, kInk);
  draw_text(canvas_, x_title, {area_.x + area_.width / 2, bottom + 38}, TextAnchor::kCenter);
  draw_text(canvas_, y_title, {area_.x, area_.y - 8}, TextAnchor::kLeft);
}

void PlotPanel::draw_line(const std::vector<cv::Point2d>& points, const cv::Scalar& color, int thickness) {
  cv::Mat inside = canvas_(area_);
  const cv::Point2d corner(area_.x, area_.y);
  for (std::size_t i = 1; i < points.size(); ++i)
    cv::line(inside, fixed_point(to_pixel(points[i - 1]) - corner), fixed_point(to_pixel(points[i]) - corner),
             color, thickness, cv::LINE_AA, kSubpixelBits);
}

void PlotPanel::draw_dot(const cv::Point2d& point, const cv::Scalar& color) {
  constexpr int kRadiusPx = 4;
  cv::circle(canvas_, fixed_point(to_pixel(point)), kRadiusPx << kSubpixelBits, color, cv::FILLED,
             cv::LINE_AA, kSubpixelBits);
}

void PlotPanel::draw_legend_entry(int row, const std::string& name, const cv::Scalar& color) {
  const cv::Point left(area_.x + 12, area_.y + 18 + 20 * row);
  cv::line(canvas_, left, left + cv::Point(24, 0), color, 2, cv::LINE_AA);
  draw_text(canvas_, name, left + cv::Point(32, 5), TextAnchor::kLeft);
}

void draw_text(cv::Mat& canvas, const std::string& text, cv::Point baseline, TextAnchor anchor,
               double scale) {
  int unused = 0;
  const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, scale, 1, &unused);
  if (anchor == TextAnchor::kCenter) baseline.x -= size.width / 2;
  if (anchor == TextAnchor::kRight) baseline.x -= size.width;
  cv::putText(canvas, text, baseline, cv::FONT_HERSHEY_SIMPLEX, scale, kInk, 1, cv::LINE_AA);
}

}  // namespace rds::evaluation
