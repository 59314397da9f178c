// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/trajectory_plot.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "common/map_file/atomic_file.hpp"
#include "tools/evaluation/plot_panel.hpp"
#include "tools/evaluation/trajectory_evaluation.hpp"

namespace rds::evaluation {
namespace {
using geometry::StampedPose;

const cv::Size kSize(1240, 660);
const cv::Rect kPathArea(70, 70, 520, 520);
const cv::Rect kTimeArea(690, 70, 520, 520);
const cv::Scalar kTruthColor(150, 150, 150);
const cv::Scalar kEstimateColor(190, 95, 20);
const cv::Scalar kErrorColor(40, 40, 200);
const std::array<cv::Scalar, 3> kAxisColors{cv::Scalar(40, 40, 200), cv::Scalar(60, 140, 40),
                                            cv::Scalar(190, 95, 20)};
const std::array<const char*, 3> kAxisNames{"x", "y", "z"};
constexpr double kGapS = 0.5;
constexpr double kCentimetres = 100;

/// A position at a time since the first estimated pose.
struct TimedPoint {
  double time_s;
  Eigen::Vector3d point;
};

std::vector<TimedPoint> timed_points(std::span<const StampedPose> poses, const geometry::Pose& world_from_map,
                                     std::int64_t origin_ns) {
  std::vector<TimedPoint> points;
  for (const auto& pose : poses)
    points.push_back({static_cast<double>(pose.stamp_ns - origin_ns) * 1e-9,
                      world_from_map * pose.map_from_camera.translation()});
  return points;
}

/// Draws what `project` makes of each sample, broken where time has a gap.
template <class Project>
void draw_broken_line(PlotPanel& panel, const std::vector<TimedPoint>& samples, const cv::Scalar& color,
                      int thickness, Project project) {
  std::vector<cv::Point2d> line;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i > 0 && samples[i].time_s - samples[i - 1].time_s > kGapS) {
      panel.draw_line(line, color, thickness);
      line.clear();
    }
    line.push_back(project(samples[i]));
  }
  panel.draw_line(line, color, thickness);
}

std::vector<double> coordinate(const std::vector<TimedPoint>& samples, int axis) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const auto& sample : samples) values.push_back(sample.point[axis]);
  return values;
}

/// The two axes along which the points spread most, in the order x, y, z.
std::array<int, 2> widest_axes(const std::vector<TimedPoint>& samples) {
  std::array<double, 3> extent{};
  for (int axis = 0; axis < 3 && !samples.empty(); ++axis) {
    const auto [low, high] = std::ranges::minmax(coordinate(samples, axis));
    extent[static_cast<std::size_t>(axis)] = high - low;
  }
  const auto narrowest = static_cast<int>(std::ranges::min_element(extent) - extent.begin());
  return {narrowest == 0 ? 1 : 0, narrowest == 2 ? 1 : 2};
}

void draw_path(cv::Mat& canvas, const std::vector<TimedPoint>& truth,
               const std::vector<TimedPoint>& estimate) {
  auto all = truth.empty() ? estimate : truth;
  const auto [across, up] = widest_axes(all);
  all.insert(all.end(), estimate.begin(), estimate.end());
  PlotPanel panel(canvas, kPathArea, range_around(coordinate(all, across)), range_around(coordinate(all, up)),
                  true);
  const auto name = [](int axis) {
    return fmt::format("{} [m]", kAxisNames.at(static_cast<std::size_t>(axis)));
  };
  panel.draw_axes(name(across), name(up));
  const auto project = [axis = across, other = up](const TimedPoint& p) {
    return cv::Point2d(p.point[axis], p.point[other]);
  };
  draw_broken_line(panel, truth, kTruthColor, 3, project);
  draw_broken_line(panel, estimate, kEstimateColor, 2, project);
  if (!estimate.empty()) panel.draw_dot(project(estimate.front()), kEstimateColor);
  panel.draw_legend_entry(0, "estimate (dot: start)", kEstimateColor);
  if (!truth.empty()) panel.draw_legend_entry(1, "ground truth", kTruthColor);
}

void draw_error(cv::Mat& canvas, const TrajectoryErrors& errors, const std::vector<TimedPoint>& estimate) {
  std::vector<TimedPoint> samples;
  std::vector<double> times;
  for (std::size_t k = 0; k < errors.pairs.size(); ++k) {
    times.push_back(estimate[errors.pairs[k].second].time_s);
    samples.push_back({times.back(), {kCentimetres * errors.error_m[k], 0, 0}});
  }
  const double highest = std::max(0.1, kCentimetres * errors.absolute_m.max);
  PlotPanel panel(canvas, kTimeArea, range_around(times), {0, 1.15 * highest}, false);
  panel.draw_axes("time [s]", "error [cm]");
  draw_broken_line(panel, samples, kErrorColor, 2,
                   [](const TimedPoint& p) { return cv::Point2d(p.time_s, p.point.x()); });
  panel.draw_legend_entry(
      0,
      fmt::format("ATE rmse {:.2f} cm, max {:.2f} cm", kCentimetres * errors.absolute_m.rmse,
                  kCentimetres * errors.absolute_m.max),
      kErrorColor);
}

void draw_position(cv::Mat& canvas, const std::vector<TimedPoint>& estimate) {
  std::vector<double> times;
  std::vector<double> values;
  for (const auto& sample : estimate) {
    times.push_back(sample.time_s);
    for (int axis = 0; axis < 3; ++axis) values.push_back(sample.point[axis]);
  }
  PlotPanel panel(canvas, kTimeArea, range_around(times), range_around(values), false);
  panel.draw_axes("time [s]", "position [m]");
  for (int axis = 0; axis < 3; ++axis) {
    const auto index = static_cast<std::size_t>(axis);
    draw_broken_line(panel, estimate, kAxisColors.at(index), 2,
                     [axis](const TimedPoint& p) { return cv::Point2d(p.time_s, p.point[axis]); });
    panel.draw_legend_entry(axis, kAxisNames.at(index), kAxisColors.at(index));
  }
}

}  // namespace

cv::Mat draw_trajectory_plot(const TrajectoryPlotInput& input) {
  cv::Mat canvas(kSize, CV_8UC3, cv::Scalar::all(255));
  const auto errors = evaluate_trajectory(input.truth, input.estimate);
  const std::int64_t origin = input.estimate.empty() ? 0 : input.estimate.front().stamp_ns;
  const auto truth =
      errors ? timed_points(input.truth, geometry::Pose::Identity(), origin) : std::vector<TimedPoint>();
  const auto estimate =
      timed_points(input.estimate, errors ? errors->truth_from_estimate : geometry::Pose::Identity(), origin);
  draw_text(canvas, input.title, {kPathArea.x, 30}, TextAnchor::kLeft, 0.6);
  draw_path(canvas, truth, estimate);
  if (errors)
    draw_error(canvas, *errors, estimate);
  else
    draw_position(canvas, estimate);
  return canvas;
}

tl::expected<void, std::string> write_trajectory_plot(const std::filesystem::path& file,
                                                      const TrajectoryPlotInput& input) {
  std::vector<std::uint8_t> content;
  try {
    cv::imencode(file.extension().string(), draw_trajectory_plot(input), content);
  } catch (const cv::Exception&) {  // an ending that is no picture format
    return tl::unexpected(
        fmt::format("{}: cannot be written, expected a picture file such as plot.png", file.string()));
  }
  return map_file::write_atomically(file, content);
}

}  // namespace rds::evaluation
