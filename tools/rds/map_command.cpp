// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/map_command.hpp"

#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/map_file/atomic_file.hpp"
#include "common/map_file/saved_map.hpp"
#include "services/mapper/core/map_files.hpp"
#include "services/mapper/core/semantic_mapper.hpp"
#include "tools/rds/bus_options.hpp"
#include "tools/rds/exit.hpp"
#include "tools/rds/interrupt.hpp"
#include "tools/rds/live_map.hpp"
#include "tools/rds/live_map_save.hpp"
#include "tools/rds/map_diff.hpp"
#include "tools/rds/map_export.hpp"

namespace rds::tools {
namespace {

struct MapOptions {
  BusOptions bus;
  std::string map;  // file; empty: live
  double timeout_s = 10;
  std::string output;
  std::string format;
  std::string up = "-y";
  std::vector<double> point;
};

LiveMap map_from_bus(const MapOptions& options) {
  const Interrupt interrupt;
  try {
    const auto participant = bus::Participant::create(options.bus.participant("rds_map"));
    auto map =
        take_live_map(*participant, std::chrono::duration<double>(options.timeout_s), interrupt.token());
    if (!map) exit_with(kExitFault, map.error());
    return std::move(*map);
  } catch (const bus::BusError& e) {
    exit_with(kExitFault, e.what());
  }
}

/// From a map.ot, .bt, map.rds, or a folder that holds one of them.
LiveMap load_file(const std::filesystem::path& path) {
  if (std::filesystem::exists(path / "map.ot") && !std::filesystem::exists(path / map_file::kMapFile))
    return load_file(path / "map.ot");
  if (mapper::looks_like_tree(path)) return {value_or_exit(mapper::read_tree(path)), 0, 0, {}};
  const auto sections = value_or_exit(map_file::read_saved_map(path, {map_file::kMapper}));
  auto saved = mapper::tree_from_map_bytes(sections.at(map_file::kMapper));
  if (!saved) exit_with(kExitBadInput, fmt::format("{}: is damaged: {}", path.string(), saved.error()));
  return {std::move(saved->tree), 0, 0, std::move(saved->labels)};
}

LiveMap load(const MapOptions& options) {
  return options.map.empty() ? map_from_bus(options) : load_file(options.map);
}

/// All that running services know, for them to go on from.
void save_all(const MapOptions& options) {
  if (!options.map.empty())
    exit_with(kExitBadInput,
              fmt::format("{}: expected no --map, an .rds is written by running services", options.output));
  const Interrupt interrupt;
  try {
    const auto participant = bus::Participant::create(options.bus.participant("rds_map"));
    const auto saved = save_live_map(*participant, options.output,
                                     std::chrono::duration<double>(options.timeout_s), interrupt.token());
    if (!saved) exit_with(kExitFault, saved.error());
  } catch (const bus::BusError& e) {
    exit_with(kExitFault, e.what());
  }
  fmt::print("{}\n", options.output);
}

void info(const MapOptions& options) {
  const LiveMap map = load(options);
  auto json = describe_map(*map.tree);
  if (options.map.empty()) {
    json["map_epoch"] = map.map_epoch;
    json["revision"] = map.revision;
    json["labels"] = map.labels;
  }
  for (const auto& [name, value] : json.items()) fmt::print("{:<16} {}\n", name, value.dump());
}

void write(const MapOptions& options, const std::string& format) {
  if (format.empty())
    exit_with(kExitBadInput, fmt::format("{}: expected an ending of {}, or --format", options.output,
                                         fmt::join(std::begin(kMapFormats), std::end(kMapFormats), ", ")));
  const LiveMap map = load(options);
  value_or_exit(export_map(*map.tree, format, options.output, options.up));
  fmt::print("{}\n", options.output);
}

bool is_rds(const std::filesystem::path& file) {
  return file.extension() == ".rds";
}

void query(const MapOptions& options) {
  const LiveMap map = load(options);
  const Eigen::Vector3d point(options.point[0], options.point[1], options.point[2]);
  fmt::print("{}\n", query_map(*map.tree, point, map.labels).dump());
}

struct DiffOptions {
  std::string a;
  std::string b;
  bool states_only = false;
  std::string output;  // PLY; empty: none
};

void print_summary(const char* name, const std::string& file, const LiveMap& map) {
  const auto json = describe_map(*map.tree);
  fmt::print("{}  {}: {} occupied and {} free voxels of {} m\n", name, file,
             json["occupied_voxels"].get<std::uint64_t>(), json["free_voxels"].get<std::uint64_t>(),
             map.tree->getResolution());
}

void diff(const DiffOptions& options) {
  const LiveMap a = load_file(options.a);
  const LiveMap b = load_file(options.b);
  if (std::abs(a.tree->getResolution() - b.tree->getResolution()) > 1e-9)
    exit_with(kExitBadInput, fmt::format("{}: voxels of {} m, expected {} m as in {}", options.b,
                                         b.tree->getResolution(), a.tree->getResolution(), options.a));
  const bool states_only = options.states_only || mapper::looks_like_binary_tree(options.a) ||
                           mapper::looks_like_binary_tree(options.b);
  std::vector<DifferencePoint> points;
  const MapDifference difference =
      compare_maps({*a.tree, a.labels}, {*b.tree, b.labels}, options.output.empty() ? nullptr : &points);
  if (!options.output.empty()) value_or_exit(map_file::write_atomically(options.output, to_ply(points)));
  print_summary("A", options.a, a);
  print_summary("B", options.b, b);
  fmt::print("{}", describe(difference, states_only));
  if (!(states_only ? difference.has_same_states() : difference.is_equal()))
    throw CLI::RuntimeError(kExitFault);
}

void add_diff_command(CLI::App& map) {
  const auto options = std::make_shared<DiffOptions>();
  auto* command =
      map.add_subcommand("diff", "What differs between two saved maps: exit 0 if nothing, 1 if something");
  command->add_option("a", options->a, "map.ot, .bt, map.rds, or a run's folder")->required();
  command->add_option("b", options->b, "The same")->required();
  command->add_flag("--states", options->states_only,
                    "Compare occupied, free, unknown alone; always so for .bt, which tells no more");
  command->add_option(
      "--out", options->output,
      "PLY file: voxels only in A red, only in B green, with another label blue, the rest grey");
  command->callback([options] { diff(*options); });
}

/// A subcommand with the options every one has.
CLI::App* add_subcommand(CLI::App& map, const std::string& name, const std::string& description,
                         const std::shared_ptr<MapOptions>& options, void (*action)(const MapOptions&)) {
  auto* command = map.add_subcommand(name, description);
  command->add_option("--map", options->map,
                      "A saved map.ot, .bt or map.rds, or a run's folder (default: the live map)");
  command->add_option("--timeout", options->timeout_s, "Wait so long for the live map [s]")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str();
  add_bus_options(*command, options->bus);
  command->callback([options, action] { action(*options); });
  return command;
}

}  // namespace

void add_map_command(CLI::App& rds) {
  auto* map = rds.add_subcommand("map", "The semantic map: from the live bus, or from a file");
  map->require_subcommand(1);
  add_subcommand(*map, "info", "Size, bounds and contents", std::make_shared<MapOptions>(), info);

  const auto saved = std::make_shared<MapOptions>();
  auto* save = add_subcommand(
      *map, "save", "Write the map as OctoMap .ot, or as .rds for the services to go on from", saved,
      [](const MapOptions& options) { is_rds(options.output) ? save_all(options) : write(options, "ot"); });
  save->add_option("file", saved->output, "File to write; .rds: the services share this file system")
      ->required();

  const auto exported = std::make_shared<MapOptions>();
  auto* exporting =
      add_subcommand(*map, "export", "Write the map for other programs: ot, bt, ply, pcd, pgm", exported,
                     [](const MapOptions& options) {
                       write(options, options.format.empty() ? format_of(options.output) : options.format);
                     });
  exporting->add_option("file", exported->output, "File to write")->required();
  exporting->add_option("--format", exported->format, "Default: the file's ending")
      ->check(CLI::IsMember(std::vector<std::string>(std::begin(kMapFormats), std::end(kMapFormats))));
  exporting->add_option("--up", exported->up, "Axis of the map frame that points up (pgm)")
      ->check(CLI::IsMember({"x", "-x", "y", "-y", "z", "-z"}))
      ->capture_default_str();

  const auto queried = std::make_shared<MapOptions>();
  auto* querying = add_subcommand(*map, "query", "What is at a point of the map frame", queried, query);
  querying->add_option("point", queried->point, "X Y Z [m]")->required()->expected(3);
  add_diff_command(*map);
}

}  // namespace rds::tools
