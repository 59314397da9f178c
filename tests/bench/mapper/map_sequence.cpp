// SPDX-License-Identifier: Apache-2.0
// Maps a recorded sequence with its true poses and writes a run's map files: how good and how fast is the
// mapper alone?
#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <iostream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "common/geometry/trajectory.hpp"
#include "common/map_file/atomic_file.hpp"
#include "services/mapper/core/map_snapshot.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "services/mapper/io/map_files.hpp"
#include "services/mapper/spill_file.hpp"
#include "tests/bench/mapper/recording.hpp"
#include "tools/rds/picture/map_picture.hpp"

namespace {

/// Time of this process on its processor, so that other work on the machine does not count.
struct Clock {
  using duration = std::chrono::nanoseconds;
  using time_point = std::chrono::time_point<Clock, duration>;
  static time_point now() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return time_point(std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec));
  }
};

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values.empty() ? 0
                        : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// What a delta's arrays take on the wire [bytes]; OctreeDelta's other fields are constant.
std::size_t bytes_of(const rds::mapper::MapDelta& delta) {
  return sizeof(std::uint16_t) * (delta.keys.size() + delta.labels.size() + delta.deleted_keys.size()) +
         sizeof(float) * delta.log_odds.size() + delta.colors.size();
}

struct Options {
  std::string dataset;
  std::string out;
  std::string config;
  std::string boxes = "people.json";
  std::size_t every = 8;
};

rds::mapper::MapperConfig read_config(const std::string& file) {
  rds::mapper::MapperConfig config;
  if (file.empty()) return config;
  auto reader = rds::config::ConfigReader::from_file(file);
  read(reader, config);
  reader.finish();
  return config;
}

void write_picture(const rds::mapper::SemanticMapper& mapper, const std::filesystem::path& file) {
  rds::tools::MapScene scene{mapper.map().tree(), mapper.map().labels.names(), {}, {}};
  for (const auto& o : mapper.map().objects(mapper.up_in_map()))
    scene.objects.push_back({o.label, o.upright.box});
  for (const auto& pose : mapper.archive().poses())
    scene.trajectory.push_back(pose.map_from_camera.translation());
  rds::tools::PictureOptions options;
  options.up = mapper.up_in_map();
  cv::imwrite(file, rds::tools::render_map(scene, options));
}

int run(const Options& options) {
  namespace fs = std::filesystem;
  const fs::path dataset = options.dataset;
  const bool has_boxes = !options.boxes.empty() && fs::exists(dataset / options.boxes);
  const rds::bench::Recording recording(dataset, has_boxes ? dataset / options.boxes : fs::path());
  const auto config = read_config(options.config);
  rds::mapper::SemanticMapper mapper(config, 1, std::make_unique<rds::mapper::SpillFile>(fs::path()));
  std::vector<double> times;
  std::vector<double> delta_shares;  // of the full map's bytes, second half
  std::size_t changed = 0;
  for (std::size_t i = 0; i < recording.size(); i += options.every) {
    const auto input = recording.keyframe(i);
    const auto start = Clock::now();
    const auto delta = mapper.integrate(input);
    times.push_back(ms_since(start));
    changed += delta.log_odds.size();
    if (i >= recording.size() / 2)
      delta_shares.push_back(static_cast<double>(bytes_of(delta)) /
                             static_cast<double>(rds::mapper::to_bytes(mapper.map().tree()).size()));
  }
  auto start = Clock::now();
  mapper.settle({});
  const double settle_ms = ms_since(start);
  start = Clock::now();
  const auto grid = make_grid(mapper.map().tree(), mapper.up_in_map(), config.grid);
  const double grid_ms = ms_since(start);
  start = Clock::now();
  const auto snapshot =
      rds::mapper::take_snapshot(mapper);  // all that publishing the full map costs the mapper
  const double snapshot_ms = ms_since(start);
  const fs::path out = options.out;
  fs::create_directories(out);
  const auto files =
      rds::mapper::files_for_others(mapper.map().tree(), mapper.map().objects(mapper.up_in_map()), grid);
  for (const auto& [name, content] : files)
    if (const auto result = rds::map_file::write_atomically(out / name, content); !result)
      throw std::runtime_error(result.error());
  std::vector<rds::geometry::StampedPose> keyframes;
  for (const auto& pose : mapper.archive().poses())
    keyframes.push_back({pose.stamp_ns, pose.map_from_camera, {}});
  if (const auto result = rds::geometry::write_trajectory(out / "keyframes.txt", keyframes); !result)
    throw std::runtime_error(result.error());
  start = Clock::now();
  write_picture(mapper, out / "map.png");
  std::cout << fmt::format(
      "{} keyframes, integrate CPU ms: median {:.2f}, p95 {:.2f}, max {:.2f}; settle {:.0f} ms; snapshot "
      "{:.1f} ms; grid {:.1f} "
      "ms; "
      "picture "
      "{:.0f} ms; {} nodes; {:.0f} changed voxels per keyframe; delta {:.3f} of the full map's bytes "
      "(median, second half); up {:.3f} {:.3f} {:.3f}; {} objects\n",
      times.size(), quantile(times, 0.5), quantile(times, 0.95), quantile(times, 1), settle_ms, snapshot_ms,
      grid_ms, ms_since(start), mapper.map().tree().size(),
      static_cast<double>(changed) / static_cast<double>(times.size()), quantile(delta_shares, 0.5),
      mapper.up_in_map().x(), mapper.up_in_map().y(), mapper.up_in_map().z(), mapper.map().objects().size());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{
      "Maps a recorded sequence with its true poses; writes map.ot, objects.json, grid, keyframes.txt, "
      "map.png"};
  app.add_option("dataset", options.dataset, "TUM-format folder with groundtruth.txt and camera.yaml")
      ->required();
  app.add_option("out", options.out, "folder for the results")->required();
  app.add_option("--every", options.every, "every n-th frame is a keyframe")->check(CLI::PositiveNumber);
  app.add_option("--config", options.config, "mapper.yaml");
  app.add_option("--boxes", options.boxes, "truth boxes in the dataset; \"\" for none");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(options);
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
}
