// SPDX-License-Identifier: Apache-2.0
// Time of one picture per network, with one and two threads. A network whose file is missing is skipped.
#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>

#include "services/detector/core/box_depth.hpp"
#include "services/detector/models/model_store.hpp"

namespace {

using namespace rds::detector;

rds::image::ColorImage noise_picture() {
  cv::RNG random(1);
  cv::Mat pixels(480, 640, CV_8UC3);
  random.fill(pixels, cv::RNG::UNIFORM, 0, 255);
  return {pixels, rds::image::ChannelOrder::kBgr, nullptr};
}

void detect(benchmark::State& state, const std::string& name) {
  try {
    DetectorConfig config;
    config.threads = static_cast<int>(state.range(0));
    Detector detector(load_network(name, model_folders()), config);
    const auto picture = noise_picture();
    for (auto _ : state) benchmark::DoNotOptimize(detector.detect(picture));
  } catch (const DetectorError& e) {
    state.SkipWithError(e.what());
  }
}
BENCHMARK_CAPTURE(detect, mobilenetv2_ssdlite_voc, "mobilenetv2_ssdlite_voc")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(detect, nanodet_g, "nanodet_g")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(detect, nanodet_m_320, "nanodet_m_320")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(detect, yolox_nano, "yolox_nano")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void depth_of_a_large_box(benchmark::State& state) {
  cv::RNG random(1);
  cv::Mat values(480, 640, CV_16UC1);
  random.fill(values, cv::RNG::UNIFORM, 0, 5000);
  const rds::image::DepthImage depth{values, 0.001F, nullptr};
  for (auto _ : state) benchmark::DoNotOptimize(box_depth(depth, {50, 20, 600, 460}));
}
BENCHMARK(depth_of_a_large_box)->Unit(benchmark::kMicrosecond);

}  // namespace
