// SPDX-License-Identifier: Apache-2.0
// What prediction adds to a frame (budget: 0.3 ms with eight objects) and to a key frame.
#include <benchmark/benchmark.h>

#include "services/tracker/core/prediction/image_projection.hpp"
#include "services/tracker/core/prediction/object_predictor.hpp"

namespace {

using namespace rds::tracker::prediction;

constexpr std::int64_t kKeyframePeriodNs = 200'000'000;

std::vector<ObjectObservation> people(int count, int keyframe) {
  std::vector<ObjectObservation> seen;
  for (int i = 0; i < count; ++i) {
    ObjectObservation person{{}, "person", 0.9F};
    person.box.map_from_box.translation() =
        Eigen::Vector3d(i - count / 2.0 + 0.1 * keyframe, 0, 3 + 0.5 * (i % 3));
    person.box.size = Eigen::Vector3d(0.5, 1.7, 0.6);
    seen.push_back(person);
  }
  return seen;
}

KeyframeView view() {
  KeyframeView view;
  view.camera.width = 640;
  view.camera.height = 480;
  view.camera.fx = view.camera.fy = 525;
  view.camera.cx = 320;
  view.camera.cy = 240;
  return view;
}

ObjectPredictor warmed_up(const char* algorithm, int objects) {
  PredictionConfig config;
  config.algorithm = algorithm;
  ObjectPredictor predictor(config);
  for (int k = 0; k < 10; ++k) predictor.update(k * kKeyframePeriodNs, people(objects, k), view());
  return predictor;
}

void predict_frame(benchmark::State& state, const char* algorithm) {
  const ObjectPredictor predictor = warmed_up(algorithm, static_cast<int>(state.range(0)));
  const rds::geometry::Pose camera_from_map = rds::geometry::Pose::Identity();
  const rds::geometry::CameraModel camera = view().camera;
  for (auto _ : state)
    for (const PredictedObject& object : predictor.predict(9 * kKeyframePeriodNs + kKeyframePeriodNs / 2))
      benchmark::DoNotOptimize(to_image(object.box, camera_from_map, camera));
}

void update_keyframe(benchmark::State& state, const char* algorithm) {
  const int objects = static_cast<int>(state.range(0));
  ObjectPredictor predictor = warmed_up(algorithm, objects);
  int k = 10;
  for (auto _ : state) {
    predictor.update(k * kKeyframePeriodNs, people(objects, k % 2), view());
    ++k;
  }
}

BENCHMARK_CAPTURE(predict_frame, paper, "paper")->Arg(1)->Arg(8)->Arg(32);
BENCHMARK_CAPTURE(predict_frame, kalman3d, "kalman3d")->Arg(1)->Arg(8)->Arg(32);
BENCHMARK_CAPTURE(update_keyframe, paper, "paper")->Arg(8)->Arg(32);
BENCHMARK_CAPTURE(update_keyframe, kalman3d, "kalman3d")->Arg(8)->Arg(32);

}  // namespace
