// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "services/viewer/core/figures/service_figures.hpp"

namespace rds::viewer {

/// Text in Prometheus' exposition format 0.0.4.
class MetricsText {
 public:
  using Labels = std::vector<std::pair<std::string_view, std::string_view>>;

  /// Begins a metric. @param type  counter, gauge, histogram or summary.
  void begin(std::string_view name, std::string_view type, std::string_view help);
  /// A sample of the metric that was begun. @param suffix  "_bucket" …
  void add(double value, const Labels& labels = {}, std::string_view suffix = "");
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string name_;
  std::string text_;
};

/// How long frames took, in buckets.
class FrameTimes {
 public:
  /// Upper bounds [s]; 33 ms is one frame at 30 Hz.
  static constexpr std::array<double, 10> kBounds{0.005, 0.01, 0.015, 0.02, 0.025, 0.033, 0.05, 0.1, 0.25, 1};

  void add(double seconds);
  void write(MetricsText& metrics) const;

 private:
  std::array<std::uint64_t, kBounds.size() + 1> counts_{};
  double sum_s_ = 0;
};

/// What the viewer itself sees of the others.
struct SceneFigures {
  int tracking_state = 0;  // rds_msgs/TrackingState
  double inliers = 0;
  double features = 0;
  double dynamic_features = 0;
  double frames = 0;
  double frames_dropped = 0;  // by the tracker
  double keyframes = 0;
  double loops_closed = 0;
  double map_voxels = 0;  // occupied
  double map_revision = 0;
  double objects = 0;
  double predicted_boxes = 0;
  double clients = 0;
};

/// /metrics.
std::string metrics_text(const SceneFigures& scene, const FrameTimes& times, const ServiceTable& services,
                         double now_s);

}  // namespace rds::viewer
