// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/map/map_diff_command.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "common/map_file/atomic_file.hpp"
#include "services/mapper/io/map_files.hpp"
#include "tools/rds/cli/exit.hpp"
#include "tools/rds/map/map_diff.hpp"
#include "tools/rds/map/map_export.hpp"
#include "tools/rds/map/map_source.hpp"

namespace rds::tools {
namespace {

struct DiffOptions {
  std::string a;
  MapSource b;
  bool states_only = false;
  std::string output;  // PLY; empty: none
};

void print_summary(const char* name, const std::string& source, const LiveMap& map) {
  const auto json = describe_map(*map.tree);
  fmt::print("{}  {}: {} occupied and {} free voxels of {} m\n", name, source,
             json["occupied_voxels"].get<std::uint64_t>(), json["free_voxels"].get<std::uint64_t>(),
             map.tree->getResolution());
}

void diff(const DiffOptions& options) {
  const LiveMap a = load_file(options.a);
  const LiveMap b = load(options.b);
  if (std::abs(a.tree->getResolution() - b.tree->getResolution()) > 1e-9)
    exit_with(kExitBadInput, fmt::format("{}: voxels of {} m, expected {} m as in {}", options.b.name(),
                                         b.tree->getResolution(), a.tree->getResolution(), options.a));
  const bool states_only = options.states_only || mapper::looks_like_binary_tree(options.a) ||
                           mapper::looks_like_binary_tree(options.b.file);
  std::vector<ColoredPoint> points;
  const MapDifference difference =
      compare_maps({*a.tree, a.labels}, {*b.tree, b.labels}, options.output.empty() ? nullptr : &points);
  if (!options.output.empty())
    value_or_exit(map_file::write_atomically(
        options.output, to_ply(points, "red: only in A, green: only in B, blue: another label")));
  print_summary("A", options.a, a);
  print_summary("B", options.b.name(), b);
  fmt::print("{}", describe(difference, states_only));
  if (!(states_only ? difference.has_same_states() : difference.is_equal()))
    throw CLI::RuntimeError(kExitFault);
}

}  // namespace

void add_map_diff_command(CLI::App& map) {
  const auto options = std::make_shared<DiffOptions>();
  auto* command =
      map.add_subcommand("diff", "What differs between two maps: exit 0 if nothing, 1 if something");
  command->add_option("a", options->a, "map.ot, .bt, map.rds, or a run's folder")->required();
  command->add_option("b", options->b.file, "The same (default: the live map)");
  command->add_flag("--states", options->states_only,
                    "Compare occupied, free, unknown alone; always so for .bt, which tells no more");
  command->add_option(
      "--out", options->output,
      "PLY file: voxels only in A red, only in B green, with another label blue, the rest grey");
  add_live_options(*command, options->b);
  command->callback([options] { diff(*options); });
}

}  // namespace rds::tools
