// SPDX-License-Identifier: Apache-2.0
// Does odometry tell how wrong it is? Runs the tracker core over recordings with exact truth and compares the
// covariance of pose and twist with their errors.
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "tests/support/odometry_consistency.hpp"
#include "tests/support/tracker_sequence.hpp"

namespace {

using rds::test::OdometryError;

std::vector<OdometryError> errors_of(const std::string& folder) {
  const auto dataset = rds::image::TumDataset::open(folder);
  if (!dataset) throw std::runtime_error(dataset.error());
  const auto truth = rds::geometry::read_trajectory(dataset->folder() / "groundtruth.txt");
  if (!truth) throw std::runtime_error(truth.error());
  // What a perfect detector reports, where the simulator has told it: people are no part of the map.
  const auto detections = dataset->folder() / "detections_truth.jsonl";
  rds::test::TrackerSequenceOptions options;
  if (exists(detections)) options.detections = detections.string();
  rds::test::TrackerSequence sequence(options, *dataset, {});
  rds::test::OdometryConsistency consistency(*truth);
  for (std::size_t i = 0; i < dataset->frames().size(); ++i)
    consistency.add(dataset->frames()[i].stamp_ns, sequence.step(i));
  return consistency.errors();
}

void run(const std::vector<std::string>& folders, bool verbose) {
  fmt::print(
      "NEES: mean, at the end, of position, of rotation; RMS and told mm, mrad; twist: mm/s, deg/s, NEES\n");
  double sum = 0, last = 0;
  for (const std::string& folder : folders) {
    const auto errors = errors_of(folder);
    const auto mean = [&](auto part) { return rds::test::mean_of(errors, part); };
    const auto median = [&](auto part) { return rds::test::median_of(errors, part); };
    if (verbose)
      for (const OdometryError& e : errors)
        fmt::print("  {:.2f} {:.2f} {:.2f} {:.2f} {:.2f} {:.2f} {:.2f}\n", e.nees, e.nees_translation,
                   e.nees_rotation, 1e3 * e.position_m, 1e3 * e.told_position_m, 1e3 * e.rotation_rad,
                   1e3 * e.told_rotation_rad);
    const double nees = mean(&OdometryError::nees);
    fmt::print("{} {:.1f} {:.1f} {:.1f} {:.1f}; {:.1f} {:.1f} {:.2f} {:.2f}; {:.1f} {:.2f} {:.1f}\n", folder,
               nees, errors.back().nees, mean(&OdometryError::nees_translation),
               mean(&OdometryError::nees_rotation), 1e3 * mean(&OdometryError::position_m),
               1e3 * mean(&OdometryError::told_position_m), 1e3 * mean(&OdometryError::rotation_rad),
               1e3 * mean(&OdometryError::told_rotation_rad), 1e3 * median(&OdometryError::speed_m_per_s),
               57.2958 * median(&OdometryError::turn_rad_per_s), median(&OdometryError::twist_nees));
    sum += nees;
    last += errors.back().nees;
  }
  const auto n = static_cast<double>(folders.size());
  fmt::print("mean of {} runs: {:.2f}, at the end {:.2f}\n", folders.size(), sum / n, last / n);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> folders;
  bool verbose = false;
  CLI::App app("Compares odometry's covariance with its errors over recordings with exact truth");
  app.add_option("recordings", folders, "TUM RGB-D folders with groundtruth.txt")->required();
  app.add_flag("--verbose", verbose, "one line per frame");
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  try {
    run(folders, verbose);
    return 0;
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
}
