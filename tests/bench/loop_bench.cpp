// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "common/vision/descriptor_matching.hpp"
#include "common/vision/place_index.hpp"

namespace {

cv::Mat random_descriptors(int rows, std::uint64_t seed) {
  cv::Mat descriptors(rows, 32, CV_8U);
  cv::RNG(seed).fill(descriptors, cv::RNG::UNIFORM, 0, 256);
  return descriptors;
}

/// Index of 1000-feature keyframes, a third of whose features are seen again in the next ones.
rds::vision::PlaceIndex filled_index(int keyframes) {
  rds::vision::PlaceIndex index;
  for (int id = 0; id < keyframes; ++id) {
    cv::Mat descriptors;
    cv::vconcat(random_descriptors(700, static_cast<std::uint64_t>(id) + 1),
                random_descriptors(300, static_cast<std::uint64_t>(id) / 5 + 10'000), descriptors);
    index.add(static_cast<std::uint64_t>(id), descriptors);
  }
  return index;
}

void place_index_query(benchmark::State& state) {
  const auto index = filled_index(static_cast<int>(state.range(0)));
  const cv::Mat query = random_descriptors(1000, 17);
  for (auto _ : state) benchmark::DoNotOptimize(index.query(query, 10));
}
BENCHMARK(place_index_query)->Arg(100)->Arg(500)->Unit(benchmark::kMillisecond);

void place_index_add(benchmark::State& state) {
  auto index = filled_index(500);
  const cv::Mat descriptors = random_descriptors(1000, 99'999);
  for (auto _ : state) index.add(1'000'000, descriptors);
}
BENCHMARK(place_index_add)->Unit(benchmark::kMillisecond);

void match_descriptors(benchmark::State& state) {
  const cv::Mat query = random_descriptors(1000, 1);
  const cv::Mat train = random_descriptors(1000, 2);
  for (auto _ : state) benchmark::DoNotOptimize(rds::vision::match_descriptors(query, train, {}));
}
BENCHMARK(match_descriptors)->Unit(benchmark::kMillisecond);

}  // namespace
