// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/map/map_source.hpp"

#include "common/map_file/saved_map.hpp"
#include "services/mapper/io/map_files.hpp"

namespace rds::tools {

void add_live_options(CLI::App& command, MapSource& source) {
  command.add_option("--timeout", source.timeout_s, "Wait so long for the live map [s]")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str();
  add_bus_options(command, source.bus);
}

LiveMap load_file(const std::filesystem::path& path) {
  if (std::filesystem::exists(path / "map.ot") && !std::filesystem::exists(path / map_file::kMapFile))
    return load_file(path / "map.ot");
  if (mapper::looks_like_tree(path)) return {value_or_exit(mapper::read_tree(path)), 0, 0, {}};
  const auto sections = value_or_exit(map_file::read_saved_map(path, {map_file::kMapper}));
  auto saved = mapper::tree_from_map_bytes(sections.at(map_file::kMapper));
  if (!saved) exit_with(kExitBadInput, fmt::format("{}: is damaged: {}", path.string(), saved.error()));
  return {std::move(saved->tree), 0, 0, std::move(saved->labels)};
}

LiveMap load(const MapSource& source) {
  return source.is_live() ? std::move(*on_the_bus(source, take_live_map)) : load_file(source.file);
}

}  // namespace rds::tools
