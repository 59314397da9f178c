// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/dataset_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "common/geometry/association.hpp"
#include "tools/evaluation/statistics.hpp"

namespace rds::tools {
namespace {
using evaluation::percentile;
using image::TumDataset;

constexpr double kMs = 1e-6;  // nanoseconds to milliseconds
constexpr std::int64_t kTruthToleranceNs = 20'000'000;
constexpr double kGapFactor = 2.5;      // of the median interval
constexpr double kLongGapMs = 500;      // a camera in a hand may have moved out of sight
constexpr double kBadShare = 0.1;       // of the frames: more of a kind is a fault
constexpr double kFrozenChange = 0.05;  // grey levels; sensor noise alone gives more
constexpr double kDarkBrightness = 30;
constexpr double kBrightBrightness = 235;
constexpr double kBlurredShare = 0.2;  // of the median sharpness
constexpr double kFewestDepthShare = 0.3;
constexpr double kNearestMedianM = 0.25;  // a Kinect sees nothing below 0.4 m
constexpr double kFarthestMedianM = 15;

double median_depth(const image::DepthImage& depth, double& measured_share) {
  std::vector<double> metres;
  int samples = 0;
  for (int y = 0; y < depth.values.rows; y += 4)
    for (int x = 0; x < depth.values.cols; x += 4, ++samples)
      if (const float z = depth.at(x, y); z > 0) metres.push_back(z);
  measured_share = static_cast<double>(metres.size()) / std::max(1, samples);
  return metres.empty() ? 0 : percentile(metres, 50);
}

FrameLook look_at(const image::RgbdFrame& frame, cv::Mat& previous_gray) {
  FrameLook look;
  look.stamp_ns = frame.stamp_ns;
  cv::Mat gray;
  frame.color.to_gray(gray);
  look.brightness = cv::mean(gray)[0];
  cv::Mat laplacian;
  cv::Laplacian(gray, laplacian, CV_16S);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(laplacian, mean, deviation);
  look.sharpness = deviation[0] * deviation[0];
  look.change = previous_gray.empty()
                    ? std::numeric_limits<double>::quiet_NaN()
                    : cv::norm(gray, previous_gray, cv::NORM_L1) / static_cast<double>(gray.total());
  look.median_depth_m = median_depth(frame.depth, look.depth_share);
  previous_gray = gray;
  return look;
}

template <class Value>
std::vector<double> values_of(const std::vector<FrameLook>& frames, Value value) {
  std::vector<double> values;
  for (const auto& frame : frames) values.push_back(value(frame));
  return values;
}

/// A finding about frames of a kind of which there should be none.
template <class IsBad>
Finding check_share(const DatasetLooks& looks, const std::string& subject, const std::string& kind,
                    IsBad is_bad) {
  const auto bad = static_cast<std::size_t>(std::ranges::count_if(looks.frames, is_bad));
  if (bad == 0)
    return {Verdict::kGood, subject, fmt::format("none of {} frames {}", looks.frames.size(), kind)};
  const auto first = std::ranges::find_if(looks.frames, is_bad);
  const bool many = static_cast<double>(bad) > kBadShare * static_cast<double>(looks.frames.size());
  return {many ? Verdict::kFault : Verdict::kHint, subject,
          fmt::format("{} of {} frames {}, the first at {:.6f} s", bad, looks.frames.size(), kind,
                      static_cast<double>(first->stamp_ns) * 1e-9)};
}

Finding check_unreadable(const DatasetLooks& looks) {
  if (looks.unreadable.empty())
    return {Verdict::kGood, "pictures", fmt::format("{} frames decoded", looks.frames.size())};
  const auto all = static_cast<double>(looks.frames.size() + looks.unreadable.size());
  const bool many = static_cast<double>(looks.unreadable.size()) > kBadShare * all;
  return {many ? Verdict::kFault : Verdict::kHint, "pictures",
          fmt::format("{} of {} frames cannot be read and will be skipped; {}", looks.unreadable.size(), all,
                      looks.unreadable.front())};
}

Finding check_depth_scale(const DatasetLooks& looks, double depth_scale) {
  std::vector<double> medians;
  for (const auto& frame : looks.frames)
    if (frame.median_depth_m > 0) medians.push_back(frame.median_depth_m);
  if (medians.empty()) return {Verdict::kFault, "depth scale", "no depth picture holds a measurement"};
  const double median = percentile(medians, 50);
  if (median >= kNearestMedianM && median <= kFarthestMedianM)
    return {Verdict::kGood, "depth scale",
            fmt::format("{} units per metre, median depth {:.2f} m", depth_scale, median)};
  std::string likely;
  for (const double other : {1000.0, 5000.0})
    if (const double m = median * depth_scale / other; m >= kNearestMedianM && m <= kFarthestMedianM)
      likely += fmt::format("; {} would give {:.2f} m", other, m);
  return {Verdict::kFault, "depth scale",
          fmt::format("{} units per metre cannot be: the median depth would be {:.3f} m{}", depth_scale,
                      median, likely)};
}

Finding check_counts(const TumDataset& dataset) {
  const auto& color = dataset.color_list();
  const auto& depth = dataset.depth_list();
  const bool many =
      static_cast<double>(dataset.unpaired()) > kBadShare * static_cast<double>(color.entries.size());
  const std::size_t repeated = color.repeated + depth.repeated;
  const Verdict verdict = many                                ? Verdict::kFault
                          : dataset.unpaired() + repeated > 0 ? Verdict::kHint
                                                              : Verdict::kGood;
  return {verdict, "frames",
          fmt::format("{} colour and {} depth pictures make {} frames; {} colour pictures without depth, {} "
                      "repeated stamps",
                      color.entries.size(), depth.entries.size(), dataset.frames().size(), dataset.unpaired(),
                      repeated)};
}

Finding check_pairing(const TumDataset& dataset) {
  std::vector<double> offsets;
  for (const auto& frame : dataset.frames())
    offsets.push_back(static_cast<double>(std::abs(frame.depth_stamp_ns - frame.stamp_ns)) * kMs);
  return {Verdict::kGood, "pairing",
          fmt::format("depth {:.1f} ms from colour in the median, {:.1f} ms at most", percentile(offsets, 50),
                      percentile(offsets, 100))};
}

Finding check_gaps(const TumDataset& dataset) {
  const auto& frames = dataset.frames();
  std::vector<double> intervals;
  for (std::size_t i = 1; i < frames.size(); ++i)
    intervals.push_back(static_cast<double>(frames[i].stamp_ns - frames[i - 1].stamp_ns) * kMs);
  if (intervals.empty()) return {Verdict::kFault, "gaps", "only one frame, nothing can be tracked"};
  const double median = percentile(intervals, 50);
  const auto gaps = std::ranges::count_if(intervals, [&](double ms) { return ms > kGapFactor * median; });
  const auto longest = std::ranges::max_element(intervals);
  const Verdict verdict = *longest > kLongGapMs ? Verdict::kFault
                          : gaps > 0            ? Verdict::kHint
                                                : Verdict::kGood;
  return {
      verdict, "gaps",
      fmt::format("{:.1f} frames/s in the median (camera: {:g}); {} gaps, the longest {:.0f} ms after {} s",
                  1000 / median, dataset.fps(), gaps, *longest,
                  frames[static_cast<std::size_t>(longest - intervals.begin())].stamp_text)};
}

Finding check_truth(const TumDataset& dataset) {
  if (!dataset.ground_truth())
    return {Verdict::kHint, "ground truth", "no groundtruth.txt: no error can be computed"};
  std::vector<std::int64_t> truth;
  for (const auto& pose : *dataset.ground_truth()) truth.push_back(pose.stamp_ns);
  std::vector<std::int64_t> frames;
  for (const auto& frame : dataset.frames()) frames.push_back(frame.stamp_ns);
  const auto pairs = geometry::associate<std::int64_t>(frames, truth, kTruthToleranceNs);
  const Verdict verdict = pairs.empty()                           ? Verdict::kFault
                          : 10 * pairs.size() < 9 * frames.size() ? Verdict::kHint
                                                                  : Verdict::kGood;
  return {verdict, "ground truth",
          fmt::format("{} poses; {} of {} frames have one within 20 ms", truth.size(), pairs.size(),
                      frames.size())};
}

}  // namespace

DatasetLooks look_at_pictures(const TumDataset& dataset, std::size_t every) {
  DatasetLooks looks;
  cv::Mat previous_gray;
  for (std::size_t i = 0; i < dataset.frames().size(); i += every) {
    const auto frame = dataset.load(dataset.frames()[i]);
    if (frame)
      looks.frames.push_back(look_at(*frame, previous_gray));
    else
      looks.unreadable.push_back(frame.error());
  }
  return looks;
}

std::vector<Finding> check_lists(const TumDataset& dataset) {
  return {check_counts(dataset), check_pairing(dataset), check_gaps(dataset), check_truth(dataset)};
}

std::vector<Finding> check_looks(const DatasetLooks& looks, double depth_scale) {
  if (looks.frames.empty())
    return {{Verdict::kFault, "pictures",
             fmt::format("none can be read; {}",
                         looks.unreadable.empty() ? "no frame" : looks.unreadable.front())}};
  const double sharp = percentile(values_of(looks.frames, [](const auto& f) { return f.sharpness; }), 50);
  return {check_unreadable(looks),
          check_depth_scale(looks, depth_scale),
          check_share(looks, "depth",
                      fmt::format("have depth at less than {:.0f} % of the pixels", 100 * kFewestDepthShare),
                      [](const auto& f) { return f.depth_share < kFewestDepthShare; }),
          check_share(looks, "frozen", "repeat the picture before",
                      [](const auto& f) { return f.change < kFrozenChange; }),
          check_share(looks, "blur", "are far less sharp than the others",
                      [&](const auto& f) { return f.sharpness < kBlurredShare * sharp; }),
          check_share(looks, "darkness", "are dark",
                      [](const auto& f) { return f.brightness < kDarkBrightness; }),
          check_share(looks, "brightness", "are over-exposed",
                      [](const auto& f) { return f.brightness > kBrightBrightness; })};
}

}  // namespace rds::tools
