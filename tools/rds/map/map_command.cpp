// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/messages/json.hpp"
#include "tools/rds/cli/commands.hpp"
#include "tools/rds/cli/exit.hpp"
#include "tools/rds/map/map_diff_command.hpp"
#include "tools/rds/map/map_export.hpp"
#include "tools/rds/map/map_merge_command.hpp"
#include "tools/rds/map/map_names_command.hpp"
#include "tools/rds/map/map_source.hpp"

namespace rds::tools {
namespace {

struct MapOptions {
  MapSource source;
  std::string output;
  std::string format;
  std::string up = "-y";
  std::vector<double> point;
};

void info(const MapOptions& options) {
  const LiveMap map = load(options.source);
  auto json = describe_map(*map.tree);
  if (options.source.is_live()) {
    json["map_epoch"] = map.map_epoch;
    json["revision"] = map.revision;
    json["labels"] = map.labels;
  }
  for (const auto& [name, value] : json.items()) fmt::print("{:<16} {}\n", name, messages::to_text(value));
}

void write(const MapOptions& options, const std::string& format) {
  if (format.empty())
    exit_with(kExitBadInput, fmt::format("{}: expected an ending of {}, or --format", options.output,
                                         fmt::join(std::begin(kMapFormats), std::end(kMapFormats), ", ")));
  const LiveMap map = load(options.source);
  value_or_exit(export_map(*map.tree, format, options.output, options.up));
  fmt::print("{}\n", options.output);
}

/// To a file of OctoMap's, or all that running services know: to a file or as a map of a name.
void save(const MapOptions& options) {
  const bool to_rds = std::filesystem::path(options.output).extension() == ".rds";
  if (!options.source.is_live() && to_rds)
    exit_with(kExitBadInput,
              fmt::format("{}: expected no --map, an .rds is written by running services", options.output));
  if (to_rds) return save_as_file(options.source, options.output);
  if (options.source.is_live() && is_map_name(options.output))
    return save_by_name(options.source, options.output);
  write(options, "ot");
}

void query(const MapOptions& options) {
  const LiveMap map = load(options.source);
  const Eigen::Vector3d point(options.point[0], options.point[1], options.point[2]);
  fmt::print("{}\n", messages::to_text(query_map(*map.tree, point, map.labels)));
}

/// A subcommand with the options every one has.
CLI::App* add_subcommand(CLI::App& map, const std::string& name, const std::string& description,
                         const std::shared_ptr<MapOptions>& options, void (*action)(const MapOptions&)) {
  auto* command = map.add_subcommand(name, description);
  command->add_option("--map", options->source.file,
                      "A saved map.ot, .bt or map.rds, or a run's folder (default: the live map)");
  add_live_options(*command, options->source);
  command->callback([options, action] { action(*options); });
  return command;
}

}  // namespace

void add_map_command(CLI::App& rds) {
  auto* map = rds.add_subcommand("map", "The semantic map: from the live bus, or from a file");
  map->require_subcommand(1);
  add_subcommand(*map, "info", "Size, bounds and contents", std::make_shared<MapOptions>(), info);

  const auto saved = std::make_shared<MapOptions>();
  auto* saving = add_subcommand(
      *map, "save", "Write the map as OctoMap .ot, or as .rds or by a name for the services to go on from",
      saved, save);
  saving->add_option("file", saved->output, "File to write, or a name in the services' folder of maps")
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
  add_map_diff_command(*map);
  add_map_merge_command(*map);
  add_map_names_commands(*map);
}

}  // namespace rds::tools
