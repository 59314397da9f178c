// SPDX-License-Identifier: Apache-2.0
// Runs the tracker core over a dataset in lockstep, without the bus, and writes the trajectories.
#include <algorithm>
#include <ctime>
#include <deque>
#include <fstream>
#include <iostream>
#include <map>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/geometry/trajectory.hpp"
#include "common/image/tum_dataset.hpp"
#include "services/tracker/core/tracker.hpp"

namespace {

using rds::geometry::StampedPose;
using rds::tracker::MovableRegion;

struct Options {
  std::string dataset;
  std::string out;
  std::string config;
  std::size_t mapping_latency = 3;
  std::size_t box_latency = 2;
  std::size_t start = 0;
  std::size_t frames = 0;
  bool truth_boxes = false;
  bool late_boxes = false;
  bool no_mapping = false;
  bool verbose = false;
};

struct TrackedPose {
  std::size_t frame;
  std::uint64_t reference;
  rds::geometry::Pose reference_from_camera;
};

/// Boxes of the people in people.json, by frame.
std::vector<std::vector<MovableRegion>> read_truth_boxes(const std::string& dataset) {
  constexpr double kMargin = 8;  // px
  std::vector<std::vector<MovableRegion>> all;
  const auto people = nlohmann::json::parse(std::ifstream(dataset + "/people.json"));
  for (const auto& frame : people.at("frames")) {
    auto& regions = all.emplace_back();
    for (const auto& person : frame.at("people")) {
      const auto box = person.at("box").get<std::array<double, 4>>();
      const auto distance = person.at("distance").get<float>();
      regions.push_back({{box[0] - kMargin, box[1] - kMargin, box[2] + kMargin, box[3] + kMargin},
                         distance - 0.6F,
                         distance + 0.6F});
    }
  }
  return all;
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Processor time of this thread [ms]: other programs on the machine do not show in it.
double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

class Run {
 public:
  Run(const Options& options, const rds::image::TumDataset& dataset,
      const rds::tracker::TrackerConfig& config)
      : options_(options), dataset_(dataset), config_(config), tracker_(config) {
    if (options.truth_boxes || options.late_boxes) boxes_ = read_truth_boxes(options.dataset);
  }

  void step(std::size_t i) {
    const auto frame = dataset_.load(dataset_.frames()[i]);
    if (!frame) throw std::runtime_error(frame.error());
    apply_due(i);
    const auto start = processor_ms();
    const auto result = tracker_.track(*frame, options_.truth_boxes ? boxes_.at(i) : none_);
    total_ms_.push_back(processor_ms() - start);
    extract_ms_.push_back(static_cast<double>(result.times.extract_us) / 1000);
    ++states_[static_cast<int>(result.state)];
    if (options_.verbose)
      fmt::print("{} state {} features {} dynamic {} inliers {} kf {} ref {} points {} ms {:.1f}\n", i,
                 static_cast<int>(result.state), result.features, result.dynamic_features, result.inliers,
                 result.keyframe.has_value(), result.reference_keyframe_id, tracker_.map().points(),
                 total_ms_.back());
    if (rds::tracker::has_pose(result.state)) {
      const auto& ref = dataset_.frames()[i];
      live_.push_back({ref.stamp_ns, result.map_from_camera, ref.stamp_text});
      tracked_.push_back({i, result.reference_keyframe_id, result.reference_from_camera});
    }
    if (!result.keyframe) return;
    ++keyframes_;
    if (options_.late_boxes) due_boxes_.push_back({i + options_.box_latency, i, result.keyframe->id});
    run_mapping(i);
  }

  void finish() const {
    std::vector<StampedPose> optimized;
    const auto keyframes = tracker_.keyframe_poses();
    for (const TrackedPose& t : tracked_) {
      const auto& ref = dataset_.frames()[t.frame];
      optimized.push_back({ref.stamp_ns, keyframes.at(t.reference).map_from_camera * t.reference_from_camera,
                           ref.stamp_text});
    }
    write(options_.out, optimized);
    write(options_.out + ".live", live_);
    fmt::print("frames {} with pose {} keyframes made {} kept {} points {} states", total_ms_.size(),
               tracked_.size(), keyframes_, tracker_.map().keyframes(), tracker_.map().points());
    for (const auto& [state, count] : states_) fmt::print(" {}:{}", state, count);
    fmt::print(
        "\nprocessor ms: total median {:.1f} p95 {:.1f} p99 {:.1f} max {:.1f}; wall of extraction median "
        "{:.1f}\n",
        percentile(total_ms_, .5), percentile(total_ms_, .95), percentile(total_ms_, .99),
        percentile(total_ms_, 1), percentile(extract_ms_, .5));
    fmt::print(
        "processor ms: mapping job median {:.1f} p95 {:.1f} max {:.1f}; snapshot median {:.1f} apply median "
        "{:.1f} max "
        "{:.1f}\n",
        percentile(mapping_ms_, .5), percentile(mapping_ms_, .95), percentile(mapping_ms_, 1),
        percentile(snapshot_ms_, .5), percentile(apply_ms_, .5), percentile(apply_ms_, 1));
  }

 private:
  struct DueBoxes {
    std::size_t at;
    std::size_t frame;
    std::uint64_t keyframe;
  };

  void apply_due(std::size_t i) {
    while (!due_boxes_.empty() && due_boxes_.front().at <= i) {
      tracker_.retract_movable(due_boxes_.front().keyframe, boxes_.at(due_boxes_.front().frame));
      due_boxes_.pop_front();
    }
    if (!result_ || result_due_ > i) return;
    const auto start = processor_ms();
    tracker_.apply(*result_);
    apply_ms_.push_back(processor_ms() - start);
    result_.reset();
  }

  void run_mapping(std::size_t i) {
    if (options_.no_mapping || result_) return;
    const auto start = processor_ms();
    const auto job = tracker_.take_mapping_job();
    snapshot_ms_.push_back(processor_ms() - start);
    if (!job) return;
    const auto begin = processor_ms();
    result_ = rds::tracker::run_local_mapping(*job, config_.local_mapping);
    mapping_ms_.push_back(processor_ms() - begin);
    result_due_ = i + options_.mapping_latency;
  }

  static void write(const std::string& file, const std::vector<StampedPose>& poses) {
    if (const auto written = rds::geometry::write_trajectory(file, poses); !written)
      throw std::runtime_error(written.error());
  }

  const Options& options_;
  const rds::image::TumDataset& dataset_;
  rds::tracker::TrackerConfig config_;
  rds::tracker::Tracker tracker_;
  std::vector<std::vector<MovableRegion>> boxes_;
  std::vector<MovableRegion> none_;
  std::deque<DueBoxes> due_boxes_;
  std::optional<rds::tracker::LocalMappingResult> result_;
  std::size_t result_due_ = 0;
  std::vector<StampedPose> live_;
  std::vector<TrackedPose> tracked_;
  std::vector<double> total_ms_, extract_ms_, mapping_ms_, snapshot_ms_, apply_ms_;
  std::map<int, int> states_;
  int keyframes_ = 0;
};

int run(const Options& options) {
  const auto dataset = rds::image::TumDataset::open(options.dataset);
  if (!dataset) throw std::runtime_error(dataset.error());
  rds::tracker::TrackerConfig config;
  if (!options.config.empty()) {
    auto reader = rds::config::ConfigReader::from_file(options.config);
    rds::tracker::read(reader, config);
    reader.finish();
  }
  Run sequence(options, *dataset, config);
  const std::size_t all = dataset->frames().size();
  const std::size_t end = options.frames > 0 ? std::min(all, options.start + options.frames) : all;
  for (std::size_t i = options.start; i < end; ++i) sequence.step(i);
  sequence.finish();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Runs the tracker core over a TUM folder in lockstep");
  app.add_option("dataset", options.dataset, "TUM RGB-D folder")->required();
  app.add_option("out", options.out, "trajectory through final keyframe poses; OUT.live gets the live one")
      ->required();
  app.add_option("--config", options.config, "YAML as the core's sections of tracker.yaml");
  app.add_option("--mapping-latency", options.mapping_latency, "frames until a mapping result is applied");
  app.add_option("--box-latency", options.box_latency, "frames until late boxes are applied");
  app.add_option("--start", options.start, "first frame");
  app.add_option("--frames", options.frames, "number of frames, 0 for all");
  app.add_flag("--truth-boxes", options.truth_boxes, "give people.json's boxes with every frame");
  app.add_flag("--late-boxes", options.late_boxes, "retract people.json's boxes from keyframes, late");
  app.add_flag("--no-mapping", options.no_mapping, "no local mapping");
  app.add_flag("--verbose", options.verbose, "one line per frame");
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  try {
    return run(options);
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
}
