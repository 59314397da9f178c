// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/evaluation/run_score.hpp"
#include "tools/evaluation/trajectory_evaluation.hpp"
#include "tools/evaluation/trajectory_plot.hpp"
#include "tools/rds/cli/commands.hpp"
#include "tools/rds/cli/exit.hpp"

namespace rds::tools {
namespace {
using evaluation::ErrorStatistics;
using evaluation::TrajectoryErrors;
using nlohmann::ordered_json;

const std::map<std::string, evaluation::Alignment> kAlignments{
    {"positions", evaluation::Alignment::kPositions}, {"orientations", evaluation::Alignment::kOrientations}};

struct EvalOptions {
  std::string truth;
  std::string estimate;
  std::string background;
  std::vector<std::string> earlier;
  std::string plot;
  int every = 5;
  evaluation::TrajectoryEvaluationOptions trajectory;
  bool json = false;
};

ordered_json to_json(const ErrorStatistics& s) {
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"max", s.max}};
}

ordered_json to_json(const TrajectoryErrors& errors, std::size_t estimated, const EvalOptions& options) {
  ordered_json json{{"pairs", errors.pairs.size()},      {"estimated", estimated},
                    {"ate", to_json(errors.absolute_m)}, {"scale", errors.similarity_scale},
                    {"span_s", errors.span_s},           {"path_m", errors.path_m}};
  if (errors.relative)
    json["rpe"] = {{"seconds", options.trajectory.rpe_interval_s},
                   {"n", errors.relative->count},
                   {"trans", to_json(errors.relative->translation_m)},
                   {"rot_deg", to_json(errors.relative->rotation_deg)}};
  return json;
}

std::string row(const char* name, const ErrorStatistics& s, int decimals) {
  return fmt::format("{:<9} rmse {:.{}f} mean {:.{}f} median {:.{}f} max {:.{}f}", name, s.rmse, decimals,
                     s.mean, decimals, s.median, decimals, s.max, decimals);
}

void print(const TrajectoryErrors& errors, std::size_t estimated, const EvalOptions& options) {
  fmt::print("pairs {} of {} estimated poses\n", errors.pairs.size(), estimated);
  fmt::print("span {:.2f} s, path {:.3f} m, similarity scale {:.4f} (not applied)\n", errors.span_s,
             errors.path_m, errors.similarity_scale);
  fmt::print("{}\n", row("ATE  m", errors.absolute_m, 4));
  if (!errors.relative) return;
  fmt::print("{}  over {:.2f} s, n {}\n", row("RPE  m", errors.relative->translation_m, 4),
             options.trajectory.rpe_interval_s, errors.relative->count);
  fmt::print("{}\n", row("RPE  deg", errors.relative->rotation_deg, 3));
}

void evaluate_files(const EvalOptions& options) {
  const auto truth = value_or_exit(geometry::read_trajectory(options.truth));
  const auto estimate = value_or_exit(geometry::read_trajectory(options.estimate));
  const auto errors = evaluation::evaluate_trajectory(truth, estimate, options.trajectory);
  if (!errors)
    exit_with(kExitBadInput,
              fmt::format("{}: expected at least 3 poses within {} s of poses of {}", options.estimate,
                          options.trajectory.max_difference_s, options.truth));
  if (options.json)
    fmt::print("{}\n", to_json(*errors, estimate.size(), options).dump());
  else
    print(*errors, estimate.size(), options);
  const std::filesystem::path plot = options.plot.empty()
                                         ? std::filesystem::path(options.estimate).replace_extension(".png")
                                         : std::filesystem::path(options.plot);
  const auto title = std::filesystem::path(options.estimate).filename().string();
  value_or_exit(evaluation::write_trajectory_plot(plot, {truth, estimate, title}));
  if (!options.json) fmt::print("plot {}\n", plot.string());
}

void evaluate_run(const EvalOptions& options) {
  std::optional<std::filesystem::path> background;
  if (!options.background.empty()) background = options.background;
  const auto figures =
      value_or_exit(evaluation::score_run({options.truth,
                                           options.estimate,
                                           background,
                                           options.every,
                                           options.trajectory.align,
                                           {options.earlier.begin(), options.earlier.end()}}));
  if (options.json)
    fmt::print("{}\n", figures.dump());
  else
    fmt::print("{}", evaluation::to_text(figures));
}

}  // namespace

void add_eval_command(CLI::App& rds) {
  auto* command = rds.add_subcommand("eval", "Compare a trajectory, or a whole run, with the truth");
  const auto options = std::make_shared<EvalOptions>();
  command->add_option("truth", options->truth, "groundtruth.txt, or the folder of the dataset")->required();
  command->add_option("estimate", options->estimate, "trajectory.txt, or the folder `rds run --out` wrote")
      ->required();
  command->add_option("--background", options->background,
                      "The same sequence without people: scores the map as well");
  command->add_option(
      "--earlier", options->earlier,
      "Recording of the same floor on an earlier day (rds simulate --visits; may be repeated): "
      "scores what has moved since");
  command->add_option("--every", options->every, "Depth pictures between two that the map is compared with")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--align", options->trajectory.align,
                   "What lays map and objects, or a trajectory, on the truth; orientations where the camera "
                   "hardly leaves its place")
      ->transform(CLI::CheckedTransformer(kAlignments))
      ->default_str("positions");
  command
      ->add_option("--max-diff", options->trajectory.max_difference_s, "Poses further apart are no pair [s]")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command->add_option("--rpe", options->trajectory.rpe_interval_s, "Interval of the relative pose error [s]")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  command->add_option("--plot", options->plot, "Picture to write (default: beside the trajectory, .png)");
  command->add_flag("--json", options->json, "Print one line of JSON");
  command->callback([options] {
    if (std::filesystem::is_directory(options->truth))
      evaluate_run(*options);
    else
      evaluate_files(*options);
  });
}

}  // namespace rds::tools
