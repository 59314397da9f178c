// SPDX-License-Identifier: Apache-2.0
// Integration of a keyframe, at 5 cm and 2 cm, beside OctoMap's own insertPointCloud with rays on the same
// points. Skipped, with the reason, without 7scenes_kitchen in RDS_SHARED.
#include <chrono>
#include <cstdlib>
#include <filesystem>

#include <benchmark/benchmark.h>
#include <octomap/OcTree.h>

#include "services/mapper/core/octree/tree_bytes.hpp"
#include "services/mapper/core/segmentation/classify.hpp"
#include "services/mapper/core/semantic_mapper.hpp"
#include "services/mapper/spill_file.hpp"
#include "tests/bench/mapper/recording.hpp"

namespace {

using namespace rds;

constexpr std::size_t kEvery = 8;  // frames
constexpr double kMmPerM = 1000;

/// Keyframes of the recording with their true poses; empty without it.
const std::vector<mapper::KeyframeInput>& keyframes() {
  static const auto loaded = [] {
    std::vector<mapper::KeyframeInput> all;
    const char* shared = std::getenv("RDS_SHARED");
    const auto folder = std::filesystem::path(shared != nullptr ? shared : "") / "data/7scenes_kitchen";
    if (shared == nullptr || !std::filesystem::exists(folder)) return all;
    const bench::Recording recording(folder, {});
    for (std::size_t i = 0; i < recording.size(); i += kEvery) {
      all.push_back(recording.keyframe(i));
      all.back().boxes.emplace();
    }
    return all;
  }();
  return loaded;
}

bool skipped(benchmark::State& state) {
  if (keyframes().empty()) state.SkipWithError("RDS_SHARED/data/7scenes_kitchen is missing");
  return keyframes().empty();
}

void integrate_keyframe(benchmark::State& state) {
  if (skipped(state)) return;
  mapper::MapperConfig config;
  config.octree.resolution_m = static_cast<double>(state.range(0)) / kMmPerM;
  mapper::SemanticMapper mapper(config, 1);
  std::size_t next = 0;
  for (auto _ : state) {
    if (next == keyframes().size()) {
      mapper.reset(1);
      next = 0;
    }
    benchmark::DoNotOptimize(mapper.integrate(keyframes()[next++]));
  }
}
BENCHMARK(integrate_keyframe)->Arg(50)->Arg(20)->Unit(benchmark::kMillisecond);

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point started) {
  return std::chrono::duration<double>(Clock::now() - started).count();
}

/// A map of so many keyframes of the recording, played again and again, and their poses.
struct LongMap {
  LongMap(std::size_t count, double resolution_m)
      : mapper(config_of(resolution_m), 1, std::make_unique<mapper::SpillFile>(std::filesystem::path())) {
    for (std::size_t i = 0; i < count; ++i) {
      auto input = keyframes()[i % keyframes().size()];
      input.id = i;
      input.stamp_ns += static_cast<std::int64_t>(i / keyframes().size()) * 60'000'000'000;
      mapper.integrate(input);
      poses.push_back({input.id, input.stamp_ns, input.map_from_camera});
    }
  }
  static mapper::MapperConfig config_of(double resolution_m) {
    mapper::MapperConfig config;
    config.octree.resolution_m = resolution_m;
    return config;
  }
  /// Moves the newest keyframes to and fro. @return the longest step [s].
  double move_newest(std::size_t count) {
    const auto moved = std::span(poses).last(count);
    for (auto& pose : moved) pose.map_from_camera.translation().x() += shift_m;
    shift_m = -shift_m;
    auto started = Clock::now();
    benchmark::DoNotOptimize(mapper.apply_poses(moved));
    double longest_s = seconds_since(started);
    while (mapper.is_correcting()) {
      started = Clock::now();
      benchmark::DoNotOptimize(mapper.go_on_correcting());
      longest_s = std::max(longest_s, seconds_since(started));
    }
    return longest_s;
  }

  mapper::SemanticMapper mapper;
  std::vector<mapper::KeyframePose> poses;
  double shift_m = 0.05;
};

/// A loop closes: 100 keyframes have new poses; until the corrected full map is there as bytes.
void correct_map_after_loop(benchmark::State& state) {
  if (skipped(state)) return;
  constexpr std::size_t kKeyframes = 100;
  LongMap map(kKeyframes, static_cast<double>(state.range(0)) / kMmPerM);
  for (auto _ : state) {
    map.move_newest(kKeyframes);
    benchmark::DoNotOptimize(mapper::to_bytes(map.mapper.map().tree()));
  }
}
BENCHMARK(correct_map_after_loop)->Arg(50)->Arg(20)->Unit(benchmark::kMillisecond);

/// Local bundle adjustment or a late loop moves 15 keyframes of a long map.
void correct_few_of_many(benchmark::State& state) {
  if (skipped(state)) return;
  constexpr std::size_t kMoved = 15;
  LongMap map(static_cast<std::size_t>(state.range(0)), mapper::OctreeConfig{}.resolution_m);
  for (auto _ : state) map.move_newest(kMoved);
}
BENCHMARK(correct_few_of_many)->Arg(500)->Arg(5000)->Unit(benchmark::kMillisecond);

/// A loop moves all keyframes of a long map, step by step.
void correct_all_of_many(benchmark::State& state) {
  if (skipped(state)) return;
  const auto count = static_cast<std::size_t>(state.range(0));
  LongMap map(count, mapper::OctreeConfig{}.resolution_m);
  double longest_s = 0;
  for (auto _ : state) longest_s = std::max(longest_s, map.move_newest(count));
  state.counters["longest_step_s"] = longest_s;
}
BENCHMARK(correct_all_of_many)->Arg(500)->Arg(5000)->Unit(benchmark::kSecond)->Iterations(1);

/// The points that the mapper uses, in the map.
octomap::Pointcloud points_of(const mapper::KeyframeInput& input) {
  const mapper::SamplingConfig sampling;
  auto record = mapper::make_record(input, sampling,
                                    std::make_shared<mapper::SampledRays>(input.camera, sampling));
  mapper::classify_by_depth(record, sampling);
  octomap::Pointcloud cloud;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (record.classes[i] != mapper::PixelClass::kStatic) continue;
    const Eigen::Vector3f p =
        (input.map_from_camera * record.point_in_camera(i).cast<double>()).cast<float>();
    cloud.push_back(p.x(), p.y(), p.z());
  }
  return cloud;
}

void octomap_insert_point_cloud(benchmark::State& state) {
  if (skipped(state)) return;
  std::vector<octomap::Pointcloud> clouds;
  for (const auto& input : keyframes()) clouds.push_back(points_of(input));
  octomap::OcTree tree(static_cast<double>(state.range(0)) / kMmPerM);
  std::size_t next = 0;
  for (auto _ : state) {
    if (next == clouds.size()) {
      tree.clear();
      next = 0;
    }
    const Eigen::Vector3f from = keyframes()[next].map_from_camera.translation().cast<float>();
    tree.insertPointCloud(clouds[next++], octomap::point3d(from.x(), from.y(), from.z()));
  }
}
BENCHMARK(octomap_insert_point_cloud)->Arg(50)->Arg(20)->Unit(benchmark::kMillisecond);

}  // namespace
