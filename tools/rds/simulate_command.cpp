// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/simulate_command.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "tools/rds/exit.hpp"
#include "tools/simulator/dataset_writer.hpp"

namespace rds::tools {
namespace {

using simulator::DatasetWriter;
using simulator::Renderer;
using simulator::Simulation;

constexpr int kMostPeople = 8;
constexpr double kLongestS = 3600;

struct SimulateOptions {
  std::string out;
  std::string path = "xyz";
  int people = 2;
  double seconds = 20;
  std::uint64_t seed = 1;
  bool force = false;
  int threads = 0;
};

simulator::SimulationOptions checked(const SimulateOptions& options) {
  const auto path = simulator::path_kind(options.path);
  if (!path)
    exit_with(kExitBadInput, fmt::format("--path {}: expected {}", options.path, simulator::path_names()));
  if (options.people < 0 || options.people > kMostPeople)
    exit_with(kExitBadInput, fmt::format("--people {}: expected 0 … {}", options.people, kMostPeople));
  if (!(options.seconds > 0 && options.seconds <= kLongestS))
    exit_with(kExitBadInput,
              fmt::format("--seconds {}: expected more than 0 and at most {}", options.seconds, kLongestS));
  if (options.threads < 0)
    exit_with(kExitBadInput, fmt::format("--threads {}: expected 0 (all cores) or more", options.threads));
  simulator::SimulationOptions checked;
  checked.path = *path;
  checked.people = options.people;
  checked.seconds = options.seconds;
  checked.seed = options.seed;
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

void simulate(const SimulateOptions& options) {
  const auto what = checked(options);
  try {
    simulator::prepare_folder(options.out, options.force);
    const Simulation simulation(what);
    DatasetWriter writer(simulation, options.out);
    const int frames = simulation.frame_count();
    fmt::print("{}: {} frames, path {}, {} people, seed {}\n", options.out, frames, options.path,
               options.people, options.seed);
    if (const auto fault = render_all(simulation, writer, thread_count(options, frames)))
      exit_with(kExitBadInput, *fault);
    writer.finish();
  } catch (const std::runtime_error& e) {
    if (dynamic_cast<const CLI::Error*>(&e) != nullptr) throw;
    exit_with(kExitBadInput, e.what());
  }
}

}  // namespace

void add_simulate_command(CLI::App& rds) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* simulate_app =
      rds.add_subcommand("simulate", "Render a recording of a room with walking people, with its truth");
  simulate_app->add_option("--out", options->out, "Folder of the recording")->required();
  simulate_app->add_option("--path", options->path, "How the camera moves: " + simulator::path_names())
      ->capture_default_str();
  simulate_app->add_option("--people", options->people, "How many people walk; 0 = the static twin")
      ->capture_default_str();
  simulate_app->add_option("--seconds", options->seconds, "Length at 30 frames a second")
      ->capture_default_str();
  simulate_app->add_option("--seed", options->seed, "Chooses room, people and paths")->capture_default_str();
  simulate_app->add_option("--threads", options->threads, "0 = one per core; the result is the same")
      ->capture_default_str();
  simulate_app->add_flag("--force", options->force, "Overwrite a recording in --out");
  simulate_app->callback([options] { simulate(*options); });
}

}  // namespace rds::tools
