// SPDX-License-Identifier: Apache-2.0
// Time of dynamic segmentation and its parts, on a made picture: somebody before a wall and a floor.
#include <random>

#include <benchmark/benchmark.h>

#include "common/dynamic_segmentation/colour_model.hpp"
#include "common/dynamic_segmentation/dynamic_segmentation.hpp"
#include "common/dynamic_segmentation/markov_field.hpp"

namespace rds::segmentation {
namespace {

const cv::Rect kPersonPx{240, 120, 160, 320};

/// A floor that comes nearer downwards before a wall 3 m away, a person 2 m away, and noise.
image::DepthImage depth_picture() {
  std::mt19937 random(1);
  std::normal_distribution<float> noise_mm(0, 5);
  cv::Mat1w mm(480, 640);
  for (int r = 0; r < mm.rows; ++r)
    for (int c = 0; c < mm.cols; ++c) {
      const float floor_mm = 700'000.0F / static_cast<float>(std::max(1, r - 240));
      const float z = kPersonPx.contains({c, r}) ? 2000.0F : std::min(3000.0F, floor_mm);
      mm(r, c) = static_cast<std::uint16_t>(z + noise_mm(random));
    }
  return {mm, 0.001F, nullptr};
}

image::ColorImage colour_picture() {
  cv::Mat3b pixels(480, 640);
  cv::randu(pixels, cv::Scalar(90, 90, 90), cv::Scalar(180, 180, 180));
  pixels(kPersonPx) = cv::Vec3b(30, 40, 160);
  return {pixels, image::ChannelOrder::kRgb, nullptr};
}

struct Picture {
  image::DepthImage depth = depth_picture();
  image::ColorImage color = colour_picture();
  GridGeometry grid{{.width = 640, .height = 480, .fx = 525, .fy = 525, .cx = 319.5, .cy = 239.5}};
  PictureCells cells = {depth_in_cells(depth, grid, 10), cv::Mat1b(grid.size(), std::uint8_t{0}),
                        colours_in_cells(color, grid.size(), grid.cell_px())};
  std::vector<SeenCells> past{2, SeenCells(cells.depth_m, {}, grid, geometry::Pose::Identity())};
  std::vector<ObjectRegion> boxes{{{230, 110, 410, 450}, 1.5F, 2.5F}};
};

void cells(benchmark::State& state) {
  const Picture p;
  for (auto _ : state) {
    benchmark::DoNotOptimize(depth_in_cells(p.depth, p.grid, 10));
    benchmark::DoNotOptimize(colours_in_cells(p.color, p.grid.size(), p.grid.cell_px()));
  }
}
BENCHMARK(cells)->Unit(benchmark::kMicrosecond);

void motion(benchmark::State& state) {
  const Picture p;
  for (auto _ : state)
    benchmark::DoNotOptimize(
        compare_with_past(p.cells.depth_m, p.grid, geometry::Pose::Identity(), p.past));
}
BENCHMARK(motion)->Unit(benchmark::kMicrosecond);

void markov_field(benchmark::State& state) {
  const Picture p;
  const Couplings couplings{cv::Mat1f(p.grid.size(), 5.0F), cv::Mat1f(p.grid.size(), 5.0F)};
  const cv::Mat1f own(p.cells.depth_m - 2.5F);
  for (auto _ : state) benchmark::DoNotOptimize(propagate(own, couplings));
}
BENCHMARK(markov_field)->Unit(benchmark::kMicrosecond);

void whole(benchmark::State& state) {
  const Picture p;
  const auto moved = compare_with_past(p.cells.depth_m, p.grid, geometry::Pose::Identity(), p.past);
  const cv::Mat1f carried = segment(p.cells, p.grid, {p.boxes, moved, {}}).presence;
  for (auto _ : state) benchmark::DoNotOptimize(segment(p.cells, p.grid, {p.boxes, moved, carried}));
}
BENCHMARK(whole)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace rds::segmentation
