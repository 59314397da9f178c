// SPDX-License-Identifier: Apache-2.0
// Runs the tracker core over a dataset in lockstep, without the bus, and writes the trajectories.
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/config/config_reader.hpp"
#include "tests/support/tracker_sequence.hpp"
#include "tools/simulator/sensors/gyroscope.hpp"

namespace {

struct Options {
  std::string dataset;
  std::string out;
  std::string config;
  std::size_t start = 0;
  std::size_t frames = 0;
  std::size_t every = 1;
  std::uint64_t gyroscope = 0;
  rds::test::TrackerSequenceOptions sequence;
};

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void write(const std::string& file, const std::vector<rds::geometry::StampedPose>& poses) {
  if (const auto written = rds::geometry::write_trajectory(file, poses); !written)
    throw std::runtime_error(written.error());
}

void print_figures(const rds::test::TrackerSequence& sequence) {
  const auto& times = sequence.times();
  const auto& map = sequence.tracker().map();
  fmt::print(
      "frames {} with pose {} keyframes made {} kept {} points {} readout {:.1f} ms focal length x {:.4f} "
      "states",
      times.total.size(), sequence.live().size(), sequence.keyframes_made(), map.keyframes().size(),
      map.points().size(), 1e3 * sequence.tracker().calibration().readout_s(),
      sequence.tracker().calibration().focal_scale());
  for (const auto& [state, count] : sequence.frames_by_state()) fmt::print(" {}:{}", state, count);
  fmt::print(
      "\nprocessor ms: total median {:.1f} p95 {:.1f} p99 {:.1f} max {:.1f}; wall of extraction median "
      "{:.1f}\n",
      percentile(times.total, .5), percentile(times.total, .95), percentile(times.total, .99),
      percentile(times.total, 1), percentile(times.extract_wall, .5));
  fmt::print(
      "processor ms: mapping job median {:.1f} p95 {:.1f} max {:.1f}; snapshot median {:.1f} apply median "
      "{:.1f} max "
      "{:.1f}\n",
      percentile(times.mapping, .5), percentile(times.mapping, .95), percentile(times.mapping, 1),
      percentile(times.snapshot, .5), percentile(times.apply, .5), percentile(times.apply, 1));
  if (!times.joining.empty())
    fmt::print("processor ms: looking for a submap's place median {:.1f} p95 {:.1f} max {:.1f}\n",
               percentile(times.joining, .5), percentile(times.joining, .95), percentile(times.joining, 1));
}

/// What a consumer's gyroscope tells of the recording's true path.
rds::tracker::Gyroscope gyroscope_of(const rds::image::TumDataset& dataset, std::uint64_t seed) {
  const auto truth = dataset.ground_truth();
  if (!truth) throw std::runtime_error("no groundtruth.txt");
  const auto buffer =
      std::make_shared<std::vector<rds::simulator::TurnRate>>(rds::simulator::gyroscope(*truth, {}, seed));
  return [buffer](std::int64_t from_ns, std::int64_t to_ns) -> std::optional<Eigen::Quaterniond> {
    constexpr std::int64_t kMarginNs = 100'000'000;
    const auto by_stamp = [](const rds::simulator::TurnRate& rate, std::int64_t ns) {
      return rate.stamp_ns < ns;
    };
    rds::tracker::GyroscopeBuffer around;
    for (auto rate = std::lower_bound(buffer->begin(), buffer->end(), from_ns - kMarginNs, by_stamp);
         rate != buffer->end() && rate->stamp_ns < to_ns + kMarginNs; ++rate)
      around.add(rate->stamp_ns, rate->rad_per_s);
    return around.turn(from_ns, to_ns);
  };
}

void print_gyroscope(const rds::tracker::GyroscopePrior& gyroscope) {
  fmt::print("turns by the gyroscope {} windows refused {} bias {:.4f} {:.4f} {:.4f} rad/s\n",
             gyroscope.told(), gyroscope.refused(), gyroscope.bias().x(), gyroscope.bias().y(),
             gyroscope.bias().z());
}

void print_removal(const rds::test::RemovalFigures& removal) {
  if (removal.frames == 0) return;
  const double n = removal.frames;
  fmt::print(
      "removed of people {:.4f} of the rest {:.4f}; features on people {:.4f} of those used; {} frames\n",
      removal.people / n, removal.rest / n, removal.features / n, removal.frames);
}

int run(const Options& options) {
  const auto dataset = rds::image::TumDataset::open(options.dataset);
  if (!dataset) throw std::runtime_error(dataset.error());
  rds::tracker::TrackerConfig config;
  if (!options.config.empty()) {
    auto reader = rds::config::ConfigReader::from_file(options.config);
    rds::tracker::read(reader, config);
    reader.finish();
  }
  auto with_gyroscope = options.sequence;
  if (options.gyroscope > 0) with_gyroscope.gyroscope = gyroscope_of(*dataset, options.gyroscope);
  rds::test::TrackerSequence sequence(with_gyroscope, *dataset, config);
  const std::size_t all = dataset->frames().size();
  const std::size_t end = options.frames > 0 ? std::min(all, options.start + options.frames) : all;
  for (std::size_t i = options.start; i < end; i += options.every) sequence.step(i);
  write(options.out, sequence.optimized());
  write(options.out + ".live", sequence.live());
  print_figures(sequence);
  print_removal(sequence.removal());
  if (options.gyroscope > 0) print_gyroscope(sequence.tracker().gyroscope());
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
  app.add_option("--mapping-latency", options.sequence.mapping_latency,
                 "frames until a mapping result is applied");
  app.add_option("--box-latency", options.sequence.box_latency, "frames until late boxes are applied");
  app.add_option("--start", options.start, "first frame");
  app.add_option("--frames", options.frames, "number of frames, 0 for all");
  app.add_option("--every", options.every, "only every n-th frame")->check(CLI::PositiveNumber);
  app.add_option("--gyroscope", options.gyroscope,
                 "a simulated gyroscope on the true path, with this seed; 0: none");
  app.add_flag("--truth-boxes", options.sequence.truth_boxes, "give people.json's boxes with every frame");
  app.add_option("--detections", options.sequence.detections,
                 "detections of every frame (detect_images); keyframes get theirs, late");
  app.add_option("--pictures", options.sequence.pictures, "existing folder for pictures of what is removed");
  app.add_flag("--masks", options.sequence.masks, "compare what is removed with masks/");
  app.add_flag("--late-boxes", options.sequence.late_boxes,
               "retract people.json's boxes from keyframes, late");
  app.add_flag("--no-mapping", options.sequence.no_mapping, "no local mapping");
  app.add_flag("--verbose", options.sequence.verbose, "one line per frame");
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  try {
    return run(options);
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
}
