// SPDX-License-Identifier: Apache-2.0
// What it costs to register a depth picture to a colour camera that stands elsewhere (budget: 5 ms).
#include <benchmark/benchmark.h>

#include "common/image/depth_registration.hpp"

namespace {

using namespace rds;

geometry::Lens lens_of(int width, int height, double focal_px) {
  return {.width = width,
          .height = height,
          .fx = focal_px,
          .fy = focal_px,
          .cx = (width - 1) / 2.0,
          .cy = (height - 1) / 2.0};
}

/// Depth of a RealSense D435's focal lengths to its colour of 1280×720.
void register_depth(benchmark::State& state, int width, int height, double focal_px, double distortion) {
  geometry::Lens color = lens_of(1280, 720, 910);
  color.coefficients[0] = distortion;
  const geometry::Lens depth = lens_of(width, height, focal_px);
  const image::DepthRegistration registration(depth, color.camera());
  cv::Mat1w values(height, width);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      values(y, x) = static_cast<std::uint16_t>((x / 40 + y / 40) % 2 == 0 ? 1500 + x : 2500 + y);
  const geometry::Pose color_from_depth = geometry::make_pose(
      {0.015, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitY())));
  for (auto _ : state)
    benchmark::DoNotOptimize(registration.depth({values, 0.001F, nullptr}, color_from_depth).values.data);
}

BENCHMARK_CAPTURE(register_depth, of_640x480, 640, 480, 385, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(register_depth, of_848x480, 848, 480, 425, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(register_depth, of_848x480_to_a_bent_lens, 848, 480, 425, 0.1)
    ->Unit(benchmark::kMillisecond);

void make_rays(benchmark::State& state) {
  const geometry::Lens depth = lens_of(848, 480, 425);
  for (auto _ : state)
    benchmark::DoNotOptimize(image::DepthRegistration(depth, lens_of(1280, 720, 910).camera()));
}
BENCHMARK(make_rays)->Unit(benchmark::kMillisecond);

}  // namespace
