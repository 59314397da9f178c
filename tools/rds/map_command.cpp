// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/map_command.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/map_file/saved_map.hpp"
#include "services/mapper/core/map_files.hpp"
#include "services/mapper/core/semantic_mapper.hpp"
#include "tools/rds/bus_options.hpp"
#include "tools/rds/exit.hpp"
#include "tools/rds/interrupt.hpp"
#include "tools/rds/live_map.hpp"
#include "tools/rds/live_map_save.hpp"
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

LiveMap load(const MapOptions& options) {
  if (options.map.empty()) return map_from_bus(options);
  if (mapper::looks_like_tree(options.map)) return {value_or_exit(mapper::read_tree(options.map)), 0, 0, {}};
  const auto sections = value_or_exit(map_file::read_saved_map(options.map, {map_file::kMapper}));
  auto saved = value_or_exit(mapper::tree_from_map_bytes(sections.at(map_file::kMapper)));
  return {std::move(saved.tree), 0, 0, std::move(saved.labels)};
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

/// A subcommand with the options every one has.
CLI::App* add_subcommand(CLI::App& map, const std::string& name, const std::string& description,
                         const std::shared_ptr<MapOptions>& options, void (*action)(const MapOptions&)) {
  auto* command = map.add_subcommand(name, description);
  command->add_option("--map", options->map, "A saved map.ot or map.rds (default: the live map)");
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
}

}  // namespace rds::tools
