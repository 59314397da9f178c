// SPDX-License-Identifier: Apache-2.0
// Time of one picture of 640 × 480 pixels, from pixels to boxes, per network and back end, with one and two
// threads; and of its parts outside the network. A network whose file is missing is left out.
#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "services/detector/core/box_depth.hpp"
#include "services/detector/core/input_transform.hpp"
#include "services/detector/models/model_store.hpp"

namespace {

using namespace rds::detector;

/// A photo with people at their desks, or noise where RDS_SHARED does not name the recordings.
rds::image::ColorImage picture() {
  const char* shared = std::getenv("RDS_SHARED");
  cv::Mat pixels;
  if (shared != nullptr)
    pixels = cv::imread(std::string(shared) + "/models/photos/tum_rgb.png", cv::IMREAD_COLOR);
  if (pixels.empty()) {
    pixels.create(480, 640, CV_8UC3);
    cv::RNG(1).fill(pixels, cv::RNG::UNIFORM, 0, 255);
  }
  return {pixels, rds::image::ChannelOrder::kBgr, nullptr};
}

void detect(benchmark::State& state, const NetworkDescription& network, DetectorConfig config) {
  try {
    config.threads = static_cast<int>(state.range(0));
    Detector detector(load_network(network, model_folders()), config);
    const auto photo = picture();
    for (auto _ : state) benchmark::DoNotOptimize(detector.detect(photo));
  } catch (const DetectorError& e) {
    state.SkipWithError(e.what());
  }
}

void input(benchmark::State& state, const NetworkDescription& network) {
  cv::setNumThreads(1);
  const auto photo = picture();
  const InputTransform place = place_picture(network.input, photo.pixels.cols, photo.pixels.rows);
  for (auto _ : state) benchmark::DoNotOptimize(make_input(network.input, place, photo));
}

void register_detect(const NetworkDescription& network, const std::string& backend,
                     const std::string& precision) {
  DetectorConfig config;
  config.backend = backend;
  config.precision = precision;
  const std::string name = fmt::format("detect/{}/{}/{}", network.name, backend, precision);
  benchmark::RegisterBenchmark(name.c_str(), detect, network, config)
      ->Arg(1)
      ->Arg(2)
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

/// Networks are known at run time only.
const bool kRegistered = [] {
  for (const NetworkDescription& network : shipped_networks()) {
    if (!find_file(network, model_folders())) continue;
    for (const std::string& backend : backends()) {
      register_detect(network, backend, "f32");
      if (backend == "openvino") register_detect(network, backend, "bf16");
    }
    benchmark::RegisterBenchmark(("input/" + network.name).c_str(), input, network)
        ->Unit(benchmark::kMicrosecond);
  }
  return true;
}();

void depth_of_a_large_box(benchmark::State& state) {
  cv::RNG random(1);
  cv::Mat values(480, 640, CV_16UC1);
  random.fill(values, cv::RNG::UNIFORM, 0, 5000);
  const rds::image::DepthImage depth{values, 0.001F, nullptr};
  for (auto _ : state) benchmark::DoNotOptimize(box_depth(depth, {50, 20, 600, 460}, 20.0));
}
BENCHMARK(depth_of_a_large_box)->Unit(benchmark::kMicrosecond);

}  // namespace
