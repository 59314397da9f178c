// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>

#include <benchmark/benchmark.h>

#include "services/tracker/core/features/orb_extractor.hpp"
#include "services/tracker/core/map/local_map.hpp"
#include "services/tracker/core/pose/feature_tracker.hpp"
#include "services/tracker/core/pose/sparse_image_alignment.hpp"
#include "services/tracker/core/relocalization/relocalizer.hpp"
#include "tests/support/tracker_sequence.hpp"

namespace rds::tracker {

inline constexpr std::size_t kFramesBefore = 150;

inline image::TumDataset open_recording() {
  const char* shared = std::getenv("RDS_SHARED");
  if (shared == nullptr || *shared == 0)
    throw std::runtime_error("RDS_SHARED is not set: it names the folder of recordings");
  auto dataset = image::TumDataset::open(std::string(shared) + "/data/7scenes_kitchen");
  if (!dataset) throw std::runtime_error(dataset.error());
  return std::move(*dataset);
}

inline image::RgbdFrame load(const image::TumDataset& dataset, std::size_t i) {
  auto frame = dataset.load(dataset.frames().at(i));
  if (!frame) throw std::runtime_error(frame.error());
  return std::move(*frame);
}

/// The tracker's state between two frames, and what the stages need of both.
struct Scene {
  Scene() : last(load(dataset, kFramesBefore - 1)), next(load(dataset, kFramesBefore)) {
    test::TrackerSequence sequence({}, dataset, config);
    for (std::size_t i = 0; i < kFramesBefore; ++i) sequence.step(i);
    map = std::make_unique<SlamMap>(sequence.tracker().map());
    last_camera_from_map = sequence.live().back().map_from_camera.inverse();
    map->keyframes().for_each([&](const Keyframe& k) {
      newest = k.id;
      places.add(k.id, static_descriptors(*k.features));
    });
    last_images = pyramid_of(last);
    next_images = pyramid_of(next);
    std::vector<PointId> all;
    map->points().for_each([&](const MapPoint& p) { all.push_back(p.id); });
    last_followed = followed(follow(all, last, *last_images), last);
    local = select_local_map(*map, last_followed.points, 1'000'000'000);
    points = last_followed.points;
    points.insert(points.end(), local.points.begin(), local.points.end());
    next_followed = followed(follow(points, next, *next_images), next);
    extracted = extract();
  }

  static std::shared_ptr<const ImagePyramid> pyramid_of(const image::RgbdFrame& frame) {
    cv::Mat gray;
    frame.color.to_gray(gray);
    return std::make_shared<const ImagePyramid>(gray, kAlignmentLevels);
  }

  [[nodiscard]] FollowedPoints follow(std::span<const PointId> ids, const image::RgbdFrame& frame,
                                      const ImagePyramid& images,
                                      const Executor& executor = execute_serially) const {
    return PointSearch(*map, ids, {frame, images, last_camera_from_map, {}}, model, pyramid, config.following.points)
        .find({}, executor);
  }

  [[nodiscard]] TrackedFrame frame_of(std::vector<Feature> features, const image::RgbdFrame& picture) const {
    complete_features(picture.camera, picture.depth, config.depth.max_depth_m, features);
    TrackedFrame frame;
    frame.stamp_ns = frame.time_ns = picture.stamp_ns;
    frame.camera_from_map = last_camera_from_map;
    frame.features = std::make_shared<const FeatureSet>(picture.camera, std::move(features));
    frame.clear_matches();
    return frame;
  }

  [[nodiscard]] TrackedFrame followed(FollowedPoints&& found, const image::RgbdFrame& picture) const {
    TrackedFrame frame = frame_of(std::move(found.features), picture);
    frame.points = std::move(found.points);
    return frame;
  }

  [[nodiscard]] TrackedFrame extract() const {
    std::vector<Feature> features;
    OrbExtractor(config.extraction).extract(next_images->level(0), {}, features);
    return frame_of(std::move(features), next);
  }

  image::TumDataset dataset = open_recording();
  TrackerConfig config;
  ScalePyramid pyramid{config.extraction.levels, config.extraction.scale_factor};
  image::RgbdFrame last, next;
  ObservationModel model{next.camera};
  std::shared_ptr<const ImagePyramid> last_images, next_images;
  std::unique_ptr<SlamMap> map;
  vision::PlaceIndex places;
  KeyframeId newest = kNoId;
  Pose last_camera_from_map = Pose::Identity();
  LocalMap local;
  std::vector<PointId> points;  // to be followed
  TrackedFrame last_followed, next_followed, extracted;
};

/// nullptr, and the benchmark skipped, if the recording is not there.
inline Scene* scene(benchmark::State& state) {
  try {
    static Scene made;
    return &made;
  } catch (const std::exception& e) {
    state.SkipWithError(e.what());
    return nullptr;
  }
}

/// A stage that changes nothing.
template <class Stage>
void measure(benchmark::State& state, Stage stage) {
  Scene* s = scene(state);
  if (s == nullptr) return;
  for (auto _ : state) benchmark::DoNotOptimize(stage(*s));
}

/// A stage that changes the map: each time a fresh copy, which is not timed.
template <class Stage>
void measure_on_copy(benchmark::State& state, Stage stage) {
  Scene* s = scene(state);
  if (s == nullptr) return;
  for (auto _ : state) {
    state.PauseTiming();
    auto map = std::make_unique<SlamMap>(*s->map);
    state.ResumeTiming();
    stage(*s, *map);
    state.PauseTiming();
    map.reset();
    state.ResumeTiming();
  }
}

}  // namespace rds::tracker
