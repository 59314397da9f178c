// SPDX-License-Identifier: Apache-2.0
// Which way is up, found in single pictures of a recording whose true poses are in a level frame: how far off
// that is, as if a map began with each of them.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/image/tum_dataset.hpp"
#include "services/tracker/core/config/tracker_config.hpp"
#include "services/tracker/core/level/plane_normals.hpp"
#include "services/tracker/core/level/up_direction.hpp"

namespace {

using rds::geometry::Pose;
using namespace rds::tracker;

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

int run(const std::string& folder, std::size_t every) {
  const auto dataset = rds::image::TumDataset::open(folder);
  if (!dataset || !dataset->ground_truth())
    throw std::runtime_error(dataset ? folder + ": no groundtruth.txt" : dataset.error());
  const rds::segmentation::GridGeometry grid(dataset->camera());
  std::vector<double> errors_deg;
  double largest_tilt_deg = 0;
  int guesses = 0;
  for (std::size_t i = 0; i < dataset->frames().size(); i += every) {
    const auto frame = dataset->load(dataset->frames()[i]);
    if (!frame) throw std::runtime_error(frame.error());
    const Pose pose = rds::geometry::interpolate(*dataset->ground_truth(), frame->stamp_ns);
    const Eigen::Vector3d up = pose.linear().transpose() * Eigen::Vector3d::UnitZ();
    const double farthest_m = DepthConfig{}.max_depth_m;
    const cv::Mat1f depth_m = rds::segmentation::depth_in_cells(frame->depth, grid, farthest_m);
    const UpDirection found = find_up(plane_normals({&grid, depth_m, {}}));
    errors_deg.push_back(degrees_between(found.up, up));
    largest_tilt_deg = std::max(largest_tilt_deg, degrees_between(up, -Eigen::Vector3d::UnitY()));
    guesses += found.is_seen ? 0 : 1;
  }
  const double first = errors_deg.front();
  std::ranges::sort(errors_deg);
  fmt::print(
      "{} pictures, tilt up to {:.0f} degrees: first {:.2f}, median {:.2f}, largest {:.2f}, {} guesses\n",
      errors_deg.size(), largest_tilt_deg, first, errors_deg[errors_deg.size() / 2], errors_deg.back(),
      guesses);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Error of the direction up that single pictures give [degrees]");
  std::string folder;
  std::size_t every = 20;
  app.add_option("RECORDING", folder, "TUM folder; z of groundtruth.txt points up")->required();
  app.add_option("--every", every, "pictures")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  try {
    return run(folder, every);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
}
