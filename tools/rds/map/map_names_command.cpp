// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/map/map_names_command.hpp"

#include <ctime>
#include <filesystem>
#include <memory>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "common/map_commands/live_map_save.hpp"
#include "common/map_file/named_map.hpp"
#include "common/store/maps_folder.hpp"
#include "tools/rds/cli/exit.hpp"

namespace rds::tools {
namespace {

void list(const std::string& folder) {
  const auto maps = value_or_exit(store::maps_folder({.maps_dir = folder}));
  for (const auto& map : value_or_exit(map_file::list_maps(maps)))
    fmt::print("{:<24} {:%Y-%m-%d %H:%M}  {:8.1f} MB  {}\n", map.name,
               fmt::localtime(static_cast<std::time_t>(map.saved_s)), static_cast<double>(map.bytes) / 1e6,
               map.parts.empty() ? "damaged" : fmt::format("{}", fmt::join(map.parts, ", ")));
}

void load_by_name(const MapSource& source, const std::string& name) {
  value_or_exit(map_file::check_map_name(name));
  const auto answers = on_the_bus(source, [&](auto& bus, const auto timeout, const auto& stop) {
    return map_commands::load_live_map(bus, name, timeout, stop);
  });
  for (const auto& [service, message] : *answers) fmt::print("{}: {}\n", service, message);
}

}  // namespace

bool is_map_name(const std::string& text) {
  const std::string ending = std::filesystem::path(text).extension().string();
  return text.find('/') == std::string::npos && ending != ".rds" && ending != ".ot" && ending != ".bt";
}

void save_by_name(const MapSource& source, const std::string& name) {
  value_or_exit(map_file::check_map_name(name));
  const auto saved = on_the_bus(source, [&](auto& bus, const auto timeout, const auto& stop) {
    return map_commands::save_live_map(bus, name, timeout, stop);
  });
  for (const auto& [service, what] : saved->by_service) fmt::print("{}: {}\n", service, what);
  fmt::print("saved as {} in {}\n", name, saved->folder.string());
}

void save_as_file(const MapSource& source, const std::string& file) {
  (void)on_the_bus(source, [&](auto& bus, const auto timeout, const auto& stop) {
    return map_commands::save_live_map_as(bus, file, timeout, stop);
  });
  fmt::print("{}\n", file);
}

void add_map_names_commands(CLI::App& map) {
  auto* listing = map.add_subcommand("list", "The saved maps of this machine, by name");
  const auto folder = std::make_shared<std::string>();
  listing->add_option("--maps-dir", *folder, "Folder of maps (default: that of the services' setting maps_dir)");
  listing->callback([folder] { list(*folder); });

  auto* loading = map.add_subcommand("load", "Have the running services go on in a saved map");
  const auto source = std::make_shared<MapSource>();
  const auto name = std::make_shared<std::string>();
  loading->add_option("name", *name, "Its name")->required();
  add_live_options(*loading, *source);
  loading->callback([source, name] { load_by_name(*source, *name); });
}

}  // namespace rds::tools
