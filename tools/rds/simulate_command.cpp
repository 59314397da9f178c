// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/rds/cli/commands.hpp"
#include "tools/rds/cli/exit.hpp"
#include "tools/simulator/building/floor_layout.hpp"
#include "tools/simulator/dataset_writer.hpp"
#include "tools/simulator/rendering/lens.hpp"

namespace rds::tools {
namespace {

using simulator::DatasetWriter;
using simulator::Renderer;
using simulator::Simulation;

constexpr int kMostPeople = 8;
constexpr int kMostVisits = 100;
constexpr double kLongestS = 3600;
constexpr int kShortestSide = 64;
constexpr int kLongestSide = 4096;
constexpr double kSlowest = 1;
constexpr double kFastest = 240;
constexpr double kCoarsestDepth = 100;
constexpr double kFinestDepth = 13000;  // the farthest measurement must fit into 16 bits

struct SimulateOptions {
  std::string out;
  std::string world = "room";
  std::optional<std::string> path;
  std::optional<int> rooms;
  std::optional<int> visits;
  int people = 2;
  double seconds = 20;
  std::optional<double> minutes;
  std::uint64_t seed = 1;
  std::string size = "640x480";
  double fps = 30;
  std::vector<double> distortion;
  double depth_scale = simulator::DepthSensor::kUnitsPerMetre;
  std::optional<double> odometry;
  bool imu = false;
  bool force = false;
  int threads = 0;
};

/// @return what --size and --distortion ask for.
geometry::CameraModel camera_of(const SimulateOptions& options) {
  int width = 0;
  int height = 0;
  char rest = 0;
  const bool is_size = std::sscanf(options.size.c_str(), "%dx%d%c", &width, &height, &rest) == 2;
  const auto is_side = [](int side) { return side >= kShortestSide && side <= kLongestSide; };
  if (!is_size || !is_side(width) || !is_side(height))
    exit_with(kExitBadInput, fmt::format("--size {}: expected WIDTHxHEIGHT, {} … {} px each", options.size,
                                         kShortestSide, kLongestSide));
  geometry::CameraModel camera = simulator::camera_of_size(width, height);
  std::ranges::copy(options.distortion, camera.distortion.begin());
  try {
    (void)simulator::Lens(camera);
  } catch (const std::invalid_argument& e) {
    exit_with(kExitBadInput,
              fmt::format("--distortion {}: {}", fmt::join(options.distortion, ","), e.what()));
  }
  return camera;
}

/// Checks --world and what belongs to one world only.
void check_world(const SimulateOptions& options, simulator::SimulationOptions& checked) {
  if (options.world == "room") {
    const auto path = simulator::path_kind(options.path.value_or("xyz"));
    if (!path)
      exit_with(kExitBadInput, fmt::format("--path {}: expected {}", *options.path, simulator::path_names()));
    if (options.rooms) exit_with(kExitBadInput, "--rooms: expected together with --world floor");
    if (options.visits) exit_with(kExitBadInput, "--visits: expected together with --world floor");
    checked.path = *path;
    return;
  }
  if (options.world != "floor")
    exit_with(kExitBadInput, fmt::format("--world {}: expected room|floor", options.world));
  if (options.path)
    exit_with(kExitBadInput, "--path: expected with --world room only; on a floor a robot drives the camera");
  checked.world = simulator::World::kFloor;
  checked.rooms = options.rooms.value_or(checked.rooms);
  if (checked.rooms < simulator::kFewestRooms || checked.rooms > simulator::kMostRooms)
    exit_with(kExitBadInput, fmt::format("--rooms {}: expected {} … {}", checked.rooms,
                                         simulator::kFewestRooms, simulator::kMostRooms));
  if (options.visits && (*options.visits < 1 || *options.visits > kMostVisits))
    exit_with(kExitBadInput, fmt::format("--visits {}: expected 1 … {}", *options.visits, kMostVisits));
}

simulator::SimulationOptions checked(const SimulateOptions& options) {
  simulator::SimulationOptions checked;
  check_world(options, checked);
  if (options.people < 0 || options.people > kMostPeople)
    exit_with(kExitBadInput, fmt::format("--people {}: expected 0 … {}", options.people, kMostPeople));
  const double seconds = options.minutes ? 60 * *options.minutes : options.seconds;
  if (!(seconds > 0 && seconds <= kLongestS))
    exit_with(kExitBadInput,
              options.minutes
                  ? fmt::format("--minutes {}: expected more than 0 and at most {}", *options.minutes,
                                kLongestS / 60)
                  : fmt::format("--seconds {}: expected more than 0 and at most {}", seconds, kLongestS));
  if (options.threads < 0)
    exit_with(kExitBadInput, fmt::format("--threads {}: expected 0 (all cores) or more", options.threads));
  if (!(options.fps >= kSlowest && options.fps <= kFastest))
    exit_with(kExitBadInput, fmt::format("--fps {}: expected {} … {}", options.fps, kSlowest, kFastest));
  if (!(options.depth_scale >= kCoarsestDepth && options.depth_scale <= kFinestDepth))
    exit_with(kExitBadInput, fmt::format("--depth-scale {}: expected {} … {} units per metre",
                                         options.depth_scale, kCoarsestDepth, kFinestDepth));
  checked.camera = camera_of(options);
  checked.rate_hz = options.fps;
  checked.depth_units_per_metre = options.depth_scale;
  checked.people = options.people;
  checked.seconds = seconds;
  checked.seed = options.seed;
  if (options.odometry && !(*options.odometry >= 0.5 && *options.odometry <= 2))
    exit_with(kExitBadInput, fmt::format("--odometry {}: expected a scale of 0.5 … 2", *options.odometry));
  checked.odometry_scale = options.odometry;
  checked.imu = options.imu;
  return checked;
}

int thread_count(const SimulateOptions& options, int frames) {
  const int wanted =
      options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
  return std::clamp(wanted, 1, frames);
}

/// Renders all frames on several threads; a frame does not depend on who renders it.
/// @return the first thread's complaint, if a file could not be written.
std::optional<std::string> render_all(const Simulation& simulation, DatasetWriter& writer, int threads) {
  std::atomic<int> next = 0;
  std::atomic<int> done = 0;
  std::mutex mutex;
  std::optional<std::string> fault;
  const int frames = simulation.frame_count();
  const auto work = [&](bool reports) {
    Renderer renderer(simulation.options().camera);
    for (int i = next++; i < frames; i = next++) {
      try {
        writer.write(i, simulation.frame(i, renderer));
      } catch (const std::exception& e) {
        const std::lock_guard lock(mutex);
        if (!fault) fault = e.what();
        next = frames;
        return;
      }
      if (++done % 60 == 0 && reports) {
        fmt::print("  {} of {} frames\n", done.load(), frames);
        std::fflush(stdout);
      }
    }
  };
  std::vector<std::jthread> workers;
  workers.reserve(static_cast<std::size_t>(threads));
  for (int i = 0; i < threads; ++i) workers.emplace_back(work, true);
  workers.clear();
  return fault;
}

/// For the line that says what is made.
std::string motion_of(const SimulateOptions& options) {
  if (options.world == "room") return "path " + options.path.value_or("xyz");
  return fmt::format("floor of {} rooms", options.rooms.value_or(simulator::SimulationOptions().rooms));
}

/// One recording in the folder `out`.
void simulate_into(const std::string& out, const SimulateOptions& options,
                   const simulator::SimulationOptions& what) {
  simulator::prepare_folder(out, options.force);
  const Simulation simulation(what);
  DatasetWriter writer(simulation, out);
  const int frames = simulation.frame_count();
  fmt::print("{}: {} frames, {}, {} people, seed {}\n", out, frames, motion_of(options), options.people,
             options.seed);
  if (const auto fault = render_all(simulation, writer, thread_count(options, frames)))
    exit_with(kExitBadInput, *fault);
  writer.finish();
}

void simulate(const SimulateOptions& options) {
  auto what = checked(options);
  try {
    if (!options.visits) return simulate_into(options.out, options, what);
    for (; what.day < *options.visits; ++what.day)
      simulate_into(fmt::format("{}/visit_{}", options.out, what.day + 1), options, what);
  } catch (const std::runtime_error& e) {
    if (dynamic_cast<const CLI::Error*>(&e) != nullptr) throw;
    exit_with(kExitBadInput, e.what());
  }
}

}  // namespace

void add_simulate_command(CLI::App& rds) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* simulate_app = rds.add_subcommand(
      "simulate", "Render a recording of a room or a floor with walking people, with its truth");
  simulate_app->add_option("--out", options->out, "Folder of the recording")->required();
  simulate_app->add_option("--world", options->world, "room, or floor: rooms along corridors of a building")
      ->capture_default_str();
  simulate_app->add_option("--rooms", options->rooms,
                           fmt::format("How many rooms the floor has, {} … {}; 12 if left out",
                                       simulator::kFewestRooms, simulator::kMostRooms));
  simulate_app->add_option("--visits", options->visits,
                           "The same floor on so many days, in OUT/visit_1 …: on each some furniture has "
                           "moved; people, light and the robot's way are others");
  simulate_app->add_option(
      "--path", options->path,
      fmt::format("How the camera moves in the room: {}; xyz if left out", simulator::path_names()));
  simulate_app->add_option("--people", options->people, "How many people walk; 0 = the static twin")
      ->capture_default_str();
  auto* seconds = simulate_app->add_option("--seconds", options->seconds, "Length")->capture_default_str();
  simulate_app->add_option("--minutes", options->minutes, "Length, in place of --seconds")->excludes(seconds);
  simulate_app->add_option("--fps", options->fps, "Frames a second")->capture_default_str();
  simulate_app
      ->add_option("--size", options->size, "WIDTHxHEIGHT [px]; the field of view is as wide at every size")
      ->capture_default_str();
  simulate_app
      ->add_option(
          "--distortion", options->distortion,
          "k1,k2,p1,p2,k3 of the lens; none if left out. Kinect: 0.2624,-0.9531,-0.0054,0.0026,1.1633")
      ->delimiter(',')
      ->expected(5);
  simulate_app
      ->add_option("--depth-scale", options->depth_scale, "Units of the depth pictures per metre; 1000: mm")
      ->capture_default_str();
  simulate_app->add_option("--odometry", options->odometry,
                           "Also write odometry.txt, what dead reckoning tells of the camera: so many times "
                           "the true way, with noise and slip, e.g. 1.05");
  simulate_app->add_flag("--imu", options->imu,
                         "Also write imu.txt, what a gyroscope and an accelerometer on the camera tell");
  simulate_app->add_option("--seed", options->seed, "Chooses room, people and paths")->capture_default_str();
  simulate_app->add_option("--threads", options->threads, "0 = one per core; the result is the same")
      ->capture_default_str();
  simulate_app->add_flag("--force", options->force, "Overwrite a recording in --out");
  simulate_app->callback([options] { simulate(*options); });
}

}  // namespace rds::tools
