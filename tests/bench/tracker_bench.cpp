// SPDX-License-Identifier: Apache-2.0
// Time of each stage of the tracker, on a frame of 7scenes_kitchen, in the map that the tracker made of the
// frames before it. Skipped, with the reason, without that recording in RDS_SHARED.
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>

#include <benchmark/benchmark.h>

#include "common/concurrency/helper_thread.hpp"
#include "services/tracker/core/feature_alignment.hpp"
#include "services/tracker/core/local_map.hpp"
#include "services/tracker/core/map_building.hpp"
#include "services/tracker/core/mapping_exchange.hpp"
#include "services/tracker/core/relocalization.hpp"
#include "services/tracker/core/sparse_image_alignment.hpp"
#include "tests/support/tracker_sequence.hpp"

namespace {

using namespace rds;
using namespace rds::tracker;

constexpr std::size_t kFramesBefore = 150;

image::TumDataset open_recording() {
  const char* shared = std::getenv("RDS_SHARED");
  if (shared == nullptr || *shared == 0)
    throw std::runtime_error("RDS_SHARED is not set: it names the folder of recordings");
  auto dataset = image::TumDataset::open(std::string(shared) + "/data/7scenes_kitchen");
  if (!dataset) throw std::runtime_error(dataset.error());
  return std::move(*dataset);
}

image::RgbdFrame load(const image::TumDataset& dataset, std::size_t i) {
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
    map->all_keyframes().for_each([&](const Keyframe& k) {
      newest = k.id;
      places.add(k.id, static_descriptors(*k.features));
    });
    last_images = pyramid_of(last);
    next_images = pyramid_of(next);
    std::vector<PointId> all;
    map->all_points().for_each([&](const MapPoint& p) { all.push_back(p.id); });
    last_followed = followed(follow(all, last, *last_images), last);
    local = select_local_map(*map, last_followed, config.map, 1'000'000'000);
    points = last_followed.points;
    points.insert(points.end(), local.points.begin(), local.points.end());
    next_followed = followed(follow(points, next, *next_images), next);
    extracted = extract();
  }

  static std::shared_ptr<const ImagePyramid> pyramid_of(const image::RgbdFrame& frame) {
    cv::Mat gray;
    frame.color.to_gray(gray);
    return std::make_shared<const ImagePyramid>(gray, FollowingConfig{}.coarsest_level + 1);
  }

  [[nodiscard]] FollowedPoints follow(std::span<const PointId> ids, const image::RgbdFrame& frame,
                                      const ImagePyramid& images,
                                      const RunParts& run_parts = run_in_turn) const {
    return follow_points(*map, ids, {frame, images, {}, last_camera_from_map, {}}, model, pyramid,
                         config.following, run_parts);
  }

  [[nodiscard]] TrackedFrame frame_of(std::vector<Feature> features, const image::RgbdFrame& picture) const {
    complete_features(picture.camera, picture.depth, config.depth.max_depth_m, features);
    TrackedFrame frame;
    frame.stamp_ns = picture.stamp_ns;
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
  ObservationModel model{next.camera, config.depth};
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
Scene* scene(benchmark::State& state) {
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

void gray_and_pyramid(benchmark::State& state) {
  measure(state, [](Scene& s) { return Scene::pyramid_of(s.next); });
}
BENCHMARK(gray_and_pyramid)->Unit(benchmark::kMicrosecond);

void orb_extraction(benchmark::State& state) {
  OrbExtractor extractor(ExtractionConfig{});
  std::vector<Feature> features;
  measure(state, [&](Scene& s) {
    extractor.extract(s.next_images->level(0), {}, features);
    return features.size();
  });
}
BENCHMARK(orb_extraction)->Unit(benchmark::kMicrosecond);

void orb_extraction_with_helper(benchmark::State& state) {
  concurrency::HelperThread helper;
  OrbExtractor extractor(ExtractionConfig{},
                         [&](std::size_t count, const auto& part) { helper.run(count, part); });
  std::vector<Feature> features;
  measure(state, [&](Scene& s) {
    extractor.extract(s.next_images->level(0), {}, features);
    return features.size();
  });
}
BENCHMARK(orb_extraction_with_helper)->Unit(benchmark::kMicrosecond)->UseRealTime();

void sparse_alignment(benchmark::State& state) {
  std::vector<SeenPoint> seen;
  measure(state, [&](Scene& s) {
    seen.clear();
    for (std::size_t i = 0; i < s.last_followed.points.size(); ++i)
      if (const MapPoint* p = s.map->point(s.last_followed.points[i]))
        seen.push_back({(*s.last_followed.features)[i].image_px, s.last_camera_from_map * p->position});
    return align_sparsely(*s.last_images, seen, *s.next_images, s.next.camera, Pose::Identity(),
                          s.config.following);
  });
}
BENCHMARK(sparse_alignment)->Unit(benchmark::kMicrosecond);

void point_following(benchmark::State& state) {
  measure(state, [](Scene& s) { return s.follow(s.points, s.next, *s.next_images); });
}
BENCHMARK(point_following)->Unit(benchmark::kMicrosecond);

void point_following_with_helper(benchmark::State& state) {
  concurrency::HelperThread helper;
  const RunParts on_both = [&](std::size_t count, const auto& part) { helper.run(count, part); };
  measure(state, [&](Scene& s) { return s.follow(s.points, s.next, *s.next_images, on_both); });
}
BENCHMARK(point_following_with_helper)->Unit(benchmark::kMicrosecond)->UseRealTime();

void feature_alignment_of_a_point(benchmark::State& state) {
  std::size_t i = 0;
  measure(state, [&](Scene& s) {
    const Feature& f = (*s.last_followed.features)[i++ % s.last_followed.features->size()];
    PatchWarp warp;
    warp.reference = s.last_images.get();
    warp.reference_px = f.image_px;
    warp.scale = s.pyramid.scale(f.level);
    return align_feature(warp, *s.next_images, f.image_px, s.config.following.max_shift_px);
  });
}
BENCHMARK(feature_alignment_of_a_point)->Unit(benchmark::kMicrosecond);

void pose_optimisation(benchmark::State& state) {
  measure(state, [](Scene& s) {
    TrackedFrame frame = s.next_followed;
    return optimize_frame(*s.map, s.model, s.pyramid, s.config.pose, frame);
  });
}
BENCHMARK(pose_optimisation)->Unit(benchmark::kMicrosecond);

void association_with_local_map(benchmark::State& state) {
  measure(state, [](Scene& s) {
    TrackedFrame frame = s.extracted;
    return match_points(*s.map, s.points, s.model, s.pyramid, s.config.matching,
                        s.config.matching.map_window_factor, frame)
        .found;
  });
}
BENCHMARK(association_with_local_map)->Unit(benchmark::kMicrosecond);

void local_map_selection(benchmark::State& state) {
  std::uint64_t mark = 2'000'000'000;
  measure(state, [&](Scene& s) { return select_local_map(*s.map, s.last_followed, s.config.map, ++mark); });
}
BENCHMARK(local_map_selection)->Unit(benchmark::kMicrosecond);

void keyframe_insertion(benchmark::State& state) {
  measure_on_copy(
      state, [](Scene& s, SlamMap& map) { insert_keyframe(map, s.extracted, s.config.depth, s.config.map); });
}
BENCHMARK(keyframe_insertion)->Unit(benchmark::kMicrosecond);

LocalMappingJob job_of(Scene& s) {
  LocalMappingJob job = make_mapping_job(*s.map, s.newest, s.config.local_mapping);
  job.pyramid = s.pyramid;
  job.depth = s.config.depth;
  job.robust = s.config.pose;
  return job;
}

void mapping_job(benchmark::State& state) {
  measure(state, [](Scene& s) { return job_of(s); });
}
BENCHMARK(mapping_job)->Unit(benchmark::kMicrosecond);

void local_mapping(benchmark::State& state) {
  measure(state, [](Scene& s) { return run_local_mapping(job_of(s), s.config.local_mapping); });
}
BENCHMARK(local_mapping)->Unit(benchmark::kMicrosecond);

void mapping_result(benchmark::State& state) {
  std::optional<LocalMappingResult> result;
  measure_on_copy(state, [&](Scene& s, SlamMap& map) {
    if (!result) {
      state.PauseTiming();
      result = run_local_mapping(job_of(s), s.config.local_mapping);
      state.ResumeTiming();
    }
    apply_mapping_result(map, *result);
  });
}
BENCHMARK(mapping_result)->Unit(benchmark::kMicrosecond);

void place_query(benchmark::State& state) {
  measure(state, [](Scene& s) { return s.places.query(static_descriptors(*s.extracted.features), 4); });
}
BENCHMARK(place_query)->Unit(benchmark::kMicrosecond);

void relocalisation_by_a_keyframe(benchmark::State& state) {
  measure(state, [](Scene& s) {
    TrackedFrame frame = s.extracted;
    const RelocalizationTools tools{s.model, s.pyramid, s.config.matching, s.config.pose,
                                    s.config.relocalization};
    return relocalize_against(*s.map, s.newest, tools, frame);
  });
}
BENCHMARK(relocalisation_by_a_keyframe)->Unit(benchmark::kMicrosecond);

}  // namespace
