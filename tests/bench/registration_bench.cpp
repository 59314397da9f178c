// SPDX-License-Identifier: Apache-2.0
// What it costs to register a depth picture to a colour camera that stands elsewhere (budget: 5 ms), or to
// another moment.
#include <benchmark/benchmark.h>

#include "common/image/depth_motion.hpp"
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

cv::Mat1w checkered(int width, int height) {
  cv::Mat1w values(height, width);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      values(y, x) = static_cast<std::uint16_t>((x / 40 + y / 40) % 2 == 0 ? 1500 + x : 2500 + y);
  return values;
}

geometry::Pose moved_by(double metres) {
  return geometry::make_pose({metres, 0, 0},
                             Eigen::Quaterniond(Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitY())));
}

/// Depth of a RealSense D435's focal lengths to its colour of 1280×720.
void register_depth(benchmark::State& state, int width, int height, double focal_px, double distortion) {
  geometry::Lens color = lens_of(1280, 720, 910);
  color.coefficients[0] = distortion;
  const geometry::Lens depth = lens_of(width, height, focal_px);
  const image::DepthRegistration registration(depth, color.camera());
  const cv::Mat1w values = checkered(width, height);
  const geometry::Pose color_from_depth = moved_by(0.015);
  for (auto _ : state)
    benchmark::DoNotOptimize(registration.depth({values, 0.001F, nullptr}, color_from_depth).values.data);
}

BENCHMARK_CAPTURE(register_depth, of_640x480, 640, 480, 385, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(register_depth, of_848x480, 848, 480, 425, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(register_depth, of_848x480_to_a_bent_lens, 848, 480, 425, 0.1)
    ->Unit(benchmark::kMillisecond);

/// Depth of another moment, to colour's time.
void move_depth(benchmark::State& state) {
  const image::DepthMotion motion(lens_of(640, 480, 525).camera());
  const cv::Mat1w values = checkered(640, 480);
  const geometry::Pose taken_from_here = moved_by(0.005);
  const auto in_turn = [](std::size_t count, const auto& part) {
    for (std::size_t i = 0; i < count; ++i) part(i);
  };
  for (auto _ : state)
    benchmark::DoNotOptimize(motion.moved({values, 0.001F, nullptr}, taken_from_here, in_turn).values.data);
}
BENCHMARK(move_depth)->Unit(benchmark::kMillisecond);

void make_rays(benchmark::State& state) {
  const geometry::Lens depth = lens_of(848, 480, 425);
  for (auto _ : state)
    benchmark::DoNotOptimize(image::DepthRegistration(depth, lens_of(1280, 720, 910).camera()));
}
BENCHMARK(make_rays)->Unit(benchmark::kMillisecond);

}  // namespace
