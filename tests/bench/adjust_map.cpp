// SPDX-License-Identifier: Apache-2.0
// Adjusts all of a saved map, bent as by drift before, and prints how long that takes and how much of the
// bend is left.
#include <cmath>
#include <ctime>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/map_file/geometry_bytes.hpp"
#include "common/map_file/saved_map.hpp"
#include "services/tracker/core/map/map_bytes.hpp"
#include "services/tracker/core/mapping/global_adjustment.hpp"
#include "services/tracker/core/motion/se3.hpp"

namespace {

using namespace rds;
using namespace rds::tracker;

struct Options {
  std::string map;
  double bend_m = 0.05;
  double bend_deg = 0.5;
};

SavedMap read_map(const std::string& path, const ExtractionConfig& extraction) {
  const auto sections = map_file::read_saved_map(path, {map_file::kTracker, map_file::kKeyframePoses});
  if (!sections) throw std::runtime_error(sections.error());
  const auto poses = map_file::keyframe_poses_from_bytes(sections->at(map_file::kKeyframePoses));
  if (!poses) throw std::runtime_error(poses.error());
  auto map = map_from_bytes(sections->at(map_file::kTracker), *poses, extraction);
  if (!map) throw std::runtime_error(map.error());
  return std::move(*map);
}

/// How the map is bent at a keyframe: slowly along the keyframes, as drift is after a loop was closed.
Pose bend_at(KeyframeId id, KeyframeId last, const Options& options) {
  const double share = static_cast<double>(id) / static_cast<double>(std::max<KeyframeId>(1, last));
  const double wave = std::sin(2 * std::numbers::pi * share);
  Twist twist = Twist::Zero();
  twist.head<3>() = options.bend_m * wave * Eigen::Vector3d(1, -1, 0.2);
  twist.tail<3>() = options.bend_deg * wave * std::numbers::pi / 180 * Eigen::Vector3d(0, 0.3, 1);
  return se3_exp(twist);
}

/// All keyframes may move but the first.
LocalMappingJob job_of(const SavedMap& saved, const ExtractionConfig& extraction, const Options& options) {
  LocalMappingJob job;
  job.next_keyframe = saved.map.records().next_id();
  job.next_point = saved.map.points().next_id();
  job.given_fx = saved.camera.given_fx;
  job.focal_scale = saved.camera.focal_scale;
  job.pyramid = ScalePyramid(extraction.levels, extraction.scale_factor);
  saved.map.keyframes().for_each([&](const Keyframe& k) {
    const Pose pose = bend_at(k.id, job.next_keyframe, options) * k.map_from_camera;
    job.keyframes.push_back({k.id, pose, k.features, k.points, k.movable, k.motion, k.given_fx, k.id == 0});
  });
  saved.map.points().for_each([&](const MapPoint& p) {
    job.points.push_back(p);
    job.points.back().position = bend_at(p.created_by, job.next_keyframe, options) * p.position;
  });
  return job;
}

double processor_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Root mean square of how far cameras are from where the saved map has them [m].
double off_m(const SavedMap& saved, const LocalMappingResult& result) {
  double sum = 0;
  for (const auto& moved : result.keyframes)
    sum += (moved.map_from_camera.translation() - saved.map.pose_of(moved.id).translation()).squaredNorm();
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, result.keyframes.size())));
}

int run(const Options& options) {
  const ExtractionConfig extraction;
  const SavedMap saved = read_map(options.map, extraction);
  const LocalMappingJob job = job_of(saved, extraction, options);
  std::size_t observations = 0;
  for (const MapPoint& p : job.points) observations += p.observations.size();
  LocalMappingResult bent;
  for (const MappingKeyframe& k : job.keyframes) bent.keyframes.push_back({k.id, k.map_from_camera});
  fmt::print("{} keyframes, {} points, {} observations\n", job.keyframes.size(), job.points.size(),
             observations);
  const double started_s = processor_s();
  const auto result = run_global_adjustment(job);
  fmt::print("processor s {:.2f}; off the saved map m before {:.4f} after {:.4f}; {} observations removed\n",
             processor_s() - started_s, off_m(saved, bent), off_m(saved, *result), result->removed.size());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Adjusts all keyframes and points of a saved map, and prints how long that takes");
  app.add_option("map", options.map, "results of rds run, or its map.rds")->required();
  app.add_option("--bend", options.bend_m, "how far the map is bent before [m]")->capture_default_str();
  app.add_option("--bend-deg", options.bend_deg, "and turned [degrees]")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    return run(options);
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
}
