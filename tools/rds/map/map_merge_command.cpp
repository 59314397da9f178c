// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/map/map_merge_command.hpp"

#include <memory>
#include <string>

#include "tools/rds/cli/exit.hpp"
#include "tools/rds/map/map_merge.hpp"

namespace rds::tools {
namespace {

struct MergeOptions {
  std::string earlier;
  std::string later;
  std::string out;
  bool json = false;
};

void merge(const MergeOptions& options) {
  if (std::filesystem::exists(options.out))  // said before the work, not after
    exit_with(kExitBadInput, fmt::format("{}: is there already, expected a new folder", options.out));
  const MapMerge merged = value_or_exit(merge_saved_maps(options.earlier, options.later));
  value_or_exit(write_map(merged, options.out));
  if (options.json)
    fmt::print("{}\n", to_json(merged.report).dump());
  else
    fmt::print("{}{}\n", describe(merged.report), options.out);
}

}  // namespace

void add_map_merge_command(CLI::App& map) {
  const auto options = std::make_shared<MergeOptions>();
  auto* command = map.add_subcommand(
      "merge", "One map of two saved ones, of two robots or two days, that have a place in common");
  command->add_option("a", options->earlier, "map.rds, or a folder that holds one; its frame stays")
      ->required();
  command->add_option("b", options->later, "The same, of a later time: what it saw gone is gone")->required();
  command->add_option("out", options->out, "Folder to write")->required();
  command->add_flag("--json", options->json, "Print one line of JSON");
  command->callback([options] { merge(*options); });
}

}  // namespace rds::tools
