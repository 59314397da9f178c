// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <memory>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/config/config_reader.hpp"
#include "common/map_file/saved_map.hpp"
#include "services/mapper/io/map_files.hpp"
#include "services/viewer/listen_address.hpp"
#include "tools/rds/cli/bus_options.hpp"
#include "tools/rds/cli/commands.hpp"
#include "tools/rds/cli/interrupt.hpp"
#include "tools/rds/cli/rate_option.hpp"
#include "tools/rds/cli/recording_option.hpp"
#include "tools/rds/run/far/far_run.hpp"
#include "tools/rds/run/far/terms.hpp"
#include "tools/rds/run/services/service_commands.hpp"
#include "tools/rds/run/session.hpp"
#include "tools/rds/topology/topology.hpp"
#include "tools/recording/open_recording.hpp"

namespace rds::run {
namespace {

constexpr int kBadUsage = 2;
constexpr const char* kViewPort = "8080";
constexpr const char* kOdometryOfRecording = "odometry.txt";
constexpr const char* kRecordBeside = "outputs.mcap";  // the results
const std::set<std::string> kProcesses{kPlayer, kTracker, kDetector, kTransformer, kMapper, kLoopCloser};

/// "fastdds", or "tracker=cyclonedds,mapper=fastdds" for single processes.
void parse_vendors(const std::string& text, RunOptions& options) {
  for (const std::string& part : CLI::detail::split(text, ',')) {
    const auto equals = part.find('=');
    const std::string name = part.substr(equals == std::string::npos ? 0 : equals + 1);
    if (std::ranges::find(bus::kVendorNames, name) == bus::kVendorNames.end())
      throw std::invalid_argument(fmt::format("--bus {}: expected {}", part, bus::kVendorChoice));
    const bus::Vendor vendor = bus::vendor_from_name(name);
    if (equals == std::string::npos) {
      options.default_vendor = vendor;
      continue;
    }
    std::string process = part.substr(0, equals);
    process = process == "player" ? kPlayer : service_of(process);
    if (process.empty())
      throw std::invalid_argument(
          fmt::format("--bus {}: expected player, tracker, detector, transformer, mapper or "
                      "loop-closer before '='",
                      part));
    options.vendors[process] = vendor;
  }
}

/// Zenoh and DDS do not hear each other.
void check_vendors(const RunOptions& options) {
  const auto on_zenoh = [&](const std::string& process) {
    return options.vendor_of(process) == bus::Vendor::kZenoh;
  };
  const auto count = std::ranges::count_if(kProcesses, on_zenoh);
  if (count != 0 && count != std::ssize(kProcesses))
    throw std::runtime_error("--bus: expected zenoh for all processes or for none, it does not meet DDS");
}

void check_view(const RunOptions& options) {
  if (options.view.empty()) return;
  if (const auto listen = viewer::parse_listen_address(options.view); !listen)
    throw std::runtime_error(fmt::format("--view={}: expected {}", options.view, listen.error()));
}

void check_files(const RunOptions& options) {
  for (const auto& file : {options.config, options.detections, options.poses, options.sensors.odometry_file})
    if (!file.empty() && !std::filesystem::is_regular_file(file))
      throw std::runtime_error(fmt::format("{}: cannot be read", file.string()));
}

/// The vendors' handshakes do not understand each other.
void check_secured(const RunOptions& options) {
  if (options.secure.folder.empty()) return;
  const bus::Vendor vendor = options.vendor_of(kPlayer);
  for (const std::string& process : kProcesses)
    if (options.vendor_of(process) != vendor)
      throw std::runtime_error(
          fmt::format("--secure: {} is on {} and {} on {}, expected one vendor for all of a secured domain",
                      kPlayer, bus::name_of(vendor), process, bus::name_of(options.vendor_of(process))));
  (void)options.secure.credentials();
}

/// The poses can be read, and reach into what is played.
void check_poses(const RunOptions& options, const image::Recording& dataset) {
  if (options.poses.empty()) return;
  const auto poses = geometry::read_trajectory(options.poses);
  if (!poses) throw std::runtime_error(poses.error());
  const auto& frames = dataset.frames();
  const auto& first = frames[options.start];
  const auto& last = frames[options.start + std::min(options.frames, frames.size() - options.start) - 1];
  if (poses->empty() || poses->back().stamp_ns < first.stamp_ns || poses->front().stamp_ns > last.stamp_ns)
    throw std::runtime_error(fmt::format("{}: expected poses between {} and {}, where the frames are",
                                         options.poses.string(), first.stamp_text, last.stamp_text));
}

/// A saved map is whole before any service starts; of an octree the mapper says what is wrong with it.
void check_map(RunOptions& options) {
  namespace saved = map_file;
  options.map_is_octree = mapper::looks_like_tree(options.map);
  if (options.localize_only && (options.map.empty() || options.map_is_octree))
    throw std::runtime_error("--localize-only: expected --map with a map.rds, or the folder of a run");
  if (options.map.empty()) return;
  if (!options.poses.empty())
    throw std::runtime_error("--poses with --map: expected one of them, given poses know no saved map");
  if (options.map_is_octree) {
    fmt::print(stderr, "{}: an octree alone; it is mapped on from where the camera starts\n",
               options.map.string());
    return;
  }
  const auto sections =
      saved::read_saved_map(options.map, {saved::kTracker, saved::kKeyframePoses, saved::kMapper});
  if (!sections) throw std::runtime_error(sections.error());
}

/// Where the services run when there are several machines.
struct HostsOptions {
  std::filesystem::path file;  // empty: all on this machine
  std::string machine;         // empty: the one with the name of this computer
};

std::optional<Elsewhere> place(RunOptions& options, const HostsOptions& where) {
  if (where.file.empty()) return std::nullopt;
  Elsewhere elsewhere{hosts::read_hosts_file(where.file), {}};
  elsewhere.here = hosts::this_machine(elsewhere.hosts, where.machine);
  Placement here{services_of(options), elsewhere.hosts.peers_of(elsewhere.here)};
  const auto& placed = elsewhere.hosts.machine(elsewhere.here).services;
  std::erase_if(here.services, [&](const auto& service) { return !placed.contains(service); });
  options.here = here;
  options.network = true;
  options.domain = options.domain.value_or(elsewhere.hosts.domain);
  return elsewhere;
}

int run(RunOptions& options, const std::string& vendors, const HostsOptions& where) {
  try {
    parse_vendors(vendors, options);
    check_vendors(options);
    check_secured(options);
    check_files(options);
    check_view(options);
    check_map(options);
    const auto elsewhere = place(options, where);
    Interrupt interrupt;
    if (elsewhere && !options.here->services.contains(kTracker))
      return FarRun(options, elsewhere->hosts, elsewhere->here).run(interrupt.token());
    if (elsewhere) check_placement(options, elsewhere->hosts, elsewhere->hosts.machine(elsewhere->here));
    if (options.dataset.empty() || options.out.empty())
      throw std::runtime_error("the recording and --out: expected where the camera is");
    const auto opened = recording::open_recording(options.dataset);
    if (!opened) throw std::runtime_error(opened.error());
    fmt::print(stderr, "{}", opened->notes);
    const image::Recording& dataset = *opened->recording;
    play::check_first_frame(dataset, options.start);
    check_poses(options, dataset);
    Session session(options, dataset, elsewhere);
    return session.run(interrupt.token());
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return kBadUsage;
  }
}

}  // namespace

void add_run_command(CLI::App& rds) {
  auto* command = rds.add_subcommand("run", "run the five services on a recording and write the results");
  auto options = std::make_shared<RunOptions>();
  auto vendors = std::make_shared<std::string>("fastdds");
  auto where = std::make_shared<HostsOptions>();
  auto odometry = std::make_shared<std::string>();
  auto no_dynamics = std::make_shared<bool>(false);
  add_recording_option(*command, options->dataset);
  command->add_option("--out", options->out, "folder for the results");
  command
      ->add_option("--bus", *vendors,
                   "fastdds, cyclonedds, zenoh, or per process: tracker=cyclonedds,mapper=fastdds")
      ->capture_default_str();
  add_rate_option(*command, options->rate);
  command->add_flag("--no-dynamics", *no_dynamics, "plain RGB-D SLAM: no detection, no prediction");
  command->add_option("--model", options->model, "network, see: rds models list");
  command->add_option("--model-dir", options->model_dir, "where its file is looked for first");
  command->add_option("--config", options->config, "YAML with a section per service");
  command->add_option("--start", options->start, "first frame");
  command->add_option("--frames", options->frames, "number of frames")->check(CLI::PositiveNumber);
  command->add_option("--detections", options->detections,
                      "boxes from a detections.jsonl or a truth file instead of the network");
  command->add_option("--poses", options->poses,
                      "poses from a TUM trajectory instead of estimated ones; no loops are closed");
  command->add_flag(fmt::format("--odometry{{{}}}", kOdometryOfRecording), *odometry,
                    "let the tracker have the recording's odometry (odometry.txt, or a topic of a bag), or "
                    "--odometry=FILE, a TUM trajectory of the camera: it carries a lost camera on");
  command->add_flag("--imu", options->sensors.imu,
                    "let the tracker have the recording's IMU (imu.txt, or a topic of a bag): which way is "
                    "up, and how the camera turns");
  command->add_option("--map", options->map,
                      "go on from a saved map: map.rds, the folder of a run, or an OctoMap tree (map.ot)");
  command->add_flag("--localize-only", options->localize_only,
                    "find the camera in that map and leave the map as it is");
  command
      ->add_option("--domain", options->domain,
                   "DDS domain, to listen from outside by --loopback or --network (default: one of its own)")
      ->check(CLI::Range(0, 232));
  command->add_option("--hosts", where->file, "which service runs on which machine; run this on each of them")
      ->check(CLI::ExistingFile);
  command->add_option("--machine", where->machine, "which of them this is (default: the computer's name)");
  add_namespace_option(*command, options->node_namespace);
  command->add_flag("--network", options->network,
                    "join the bus as other programs do, ROS 2 tools for example, not on the loopback alone");
  command
      ->add_option("--secure", options->secure.folder, "run on a secured domain: folder of rds secure init")
      ->envname("RDS_SECURE");
  command->add_flag(
      "--view{8080}", options->view,
      "serve a page that shows the run: --view=PORT or --view=ADDRESS:PORT (default: 127.0.0.1:8080)");
  command->add_flag("--view-keep", options->view_keep,
                    "as --view, and the page stays after the results, until Ctrl-C");
  command->add_flag(fmt::format("--record{{{}}}", kRecordBeside), options->record,
                    "keep all outputs as MCAP, in outputs.mcap beside the results or --record=FILE");
  command
      ->add_option("--frame", options->frame,
                   "of trajectory*.txt: camera, the first one's, or map, level as the other files; default: "
                   "camera, with --map or --poses map")
      ->check(CLI::IsMember({"camera", "map"}));
  command->add_flag("--video", options->video, "write overlay.avi");
  command->add_flag("--force", options->force, "overwrite an earlier run");
  command->callback([options, vendors, where, odometry, no_dynamics] {
    options->sensors.odometry = !odometry->empty();
    if (*odometry != kOdometryOfRecording) options->sensors.odometry_file = *odometry;
    options->dynamics = !*no_dynamics;
    if (options->view_keep && options->view.empty()) options->view = kViewPort;
    const int status = run(*options, *vendors, *where);
    if (status != 0) throw CLI::RuntimeError(status);
  });
}

}  // namespace rds::run
