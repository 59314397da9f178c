// SPDX-License-Identifier: Apache-2.0
// Time of each stage of the tracker, on a frame of 7scenes_kitchen, in the map that the tracker made of the
// frames before it. Skipped, with the reason, without that recording in RDS_SHARED.
#include "common/concurrency/parallel_for.hpp"
#include "services/tracker/core/mapping/map_building.hpp"
#include "services/tracker/core/mapping/mapping_exchange.hpp"
#include "services/tracker/core/pose/feature_alignment.hpp"
#include "services/tracker/core/pose/sparse_image_alignment.hpp"
#include "tests/bench/tracker_bench_scene.hpp"

namespace {

using namespace rds;
using namespace rds::tracker;

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
  concurrency::ParallelFor helper;
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
    return align_sparsely(*s.last_images, seen, *s.next_images, s.next.camera, Pose::Identity());
  });
}
BENCHMARK(sparse_alignment)->Unit(benchmark::kMicrosecond);

void point_following(benchmark::State& state) {
  measure(state, [](Scene& s) { return s.follow(s.points, s.next, *s.next_images); });
}
BENCHMARK(point_following)->Unit(benchmark::kMicrosecond);

void point_following_with_helper(benchmark::State& state) {
  concurrency::ParallelFor helper;
  const Executor on_both = [&](std::size_t count, const auto& part) { helper.run(count, part); };
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
    return align_feature(warp, *s.next_images, f.image_px, 3);
  });
}
BENCHMARK(feature_alignment_of_a_point)->Unit(benchmark::kMicrosecond);

void pose_optimisation(benchmark::State& state) {
  measure(state, [](Scene& s) {
    TrackedFrame frame = s.next_followed;
    return optimize_frame(*s.map, s.model, s.pyramid, frame);
  });
}
BENCHMARK(pose_optimisation)->Unit(benchmark::kMicrosecond);

void association_with_local_map(benchmark::State& state) {
  measure(state, [](Scene& s) {
    TrackedFrame frame = s.extracted;
    return match_points(*s.map, s.points, s.model, s.pyramid, FeatureTracker::kUsualWindow, frame)
        .found;
  });
}
BENCHMARK(association_with_local_map)->Unit(benchmark::kMicrosecond);

void local_map_selection(benchmark::State& state) {
  std::uint64_t mark = 2'000'000'000;
  measure(state,
          [&](Scene& s) { return select_local_map(*s.map, s.last_followed.points, ++mark); });
}
BENCHMARK(local_map_selection)->Unit(benchmark::kMicrosecond);

void keyframe_insertion(benchmark::State& state) {
  measure_on_copy(
      state, [](Scene& s, SlamMap& map) { insert_keyframe(map, s.extracted, s.config.depth); });
}
BENCHMARK(keyframe_insertion)->Unit(benchmark::kMicrosecond);

LocalMappingJob job_of(Scene& s) {
  LocalMappingJob job = make_mapping_job(*s.map, s.newest);
  job.pyramid = s.pyramid;
  return job;
}

void mapping_job(benchmark::State& state) {
  measure(state, [](Scene& s) { return job_of(s); });
}
BENCHMARK(mapping_job)->Unit(benchmark::kMicrosecond);

void local_mapping(benchmark::State& state) {
  measure(state, [](Scene& s) { return run_local_mapping(job_of(s)); });
}
BENCHMARK(local_mapping)->Unit(benchmark::kMicrosecond);

void mapping_result(benchmark::State& state) {
  std::optional<LocalMappingResult> result;
  measure_on_copy(state, [&](Scene& s, SlamMap& map) {
    if (!result) {
      state.PauseTiming();
      result = run_local_mapping(job_of(s));
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
  Relocalizer relocalizer;
  measure(state, [&](Scene& s) {
    if (relocalizer.places() == 0) {
      relocalizer.add(s.newest);
      relocalizer.index_pending(*s.map);
    }
    const PoseSettings settings{s.pyramid, s.config.depth};
    const TrackingContext context{*s.map, settings, s.next, s.model, {}, {}};
    TrackedFrame frame = s.extracted;
    return relocalizer.localize(context, [](const Keyframe&) { return true; }, frame);
  });
}
BENCHMARK(relocalisation_by_a_keyframe)->Unit(benchmark::kMicrosecond);

}  // namespace
