// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/results/results.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/messages/json.hpp"
#include "tools/evaluation/trajectory_evaluation.hpp"
#include "tools/evaluation/trajectory_plot.hpp"
#include "tools/rds/run/output/result_file.hpp"
#include "tools/rds/run/results/map_image.hpp"
#include "tools/rds/run/results/run_files.hpp"

namespace rds::run {
namespace {

using geometry::StampedPose;

void check(const tl::expected<void, std::string>& written) {
  if (!written) throw std::runtime_error(written.error());
}

std::span<const StampedPose> truth_of(const image::Recording& dataset) {
  if (!dataset.ground_truth()) return {};
  return *dataset.ground_truth();
}

std::optional<double> ate_of(const image::Recording& dataset, const std::vector<StampedPose>& poses) {
  const auto errors = evaluation::evaluate_trajectory(truth_of(dataset), poses);
  return errors ? std::optional(errors->absolute_m.rmse) : std::nullopt;
}

void print_main_figures(const nlohmann::ordered_json& s) {
  const auto& frames = s["frames"];
  fmt::print(
      "{} frames played, {} tracked, {} lost, {} dropped, {} keyframes, {} loops closed, {:.1f} frames/s\n",
      frames["played"].get<int>(), frames["tracked"].get<int>(), frames["lost"].get<int>(),
      frames["dropped"].get<int>(), frames["keyframes"].get<int>(), s["loops_closed"].get<int>(),
      s["frames_per_s"].get<double>());
  if (s.contains("map") && s["map"].contains("delay_s"))
    fmt::print("map         {} keyframes, {} missing, delay [s] median {:.2f}  p99 {:.2f}\n",
               s["map"]["keyframes"].get<int>(), s["map"]["keyframes_missing"].get<int>(),
               s["map"]["delay_s"]["median"].get<double>(), s["map"]["delay_s"]["p99"].get<double>());
  for (const char* stage : {"total_ms", "extract_ms", "track_ms", "predict_ms"})
    fmt::print("{:<10}  median {:6.2f}  p95 {:6.2f}  p99 {:6.2f}\n", stage, s[stage]["median"].get<double>(),
               s[stage]["p95"].get<double>(), s[stage]["p99"].get<double>());
  if (s.contains("ate_final"))
    fmt::print("ATE [m]     live {:.4f}  final {:.4f}\n", s["ate_live"].get<double>(),
               s["ate_final"].get<double>());
}

}  // namespace

void write_all_results(SummaryInput input, const image::Recording& dataset,
                       const std::filesystem::path& folder) {
  write_run_files(input.recording, folder, input.options.trajectories_in_map());
  const std::vector<StampedPose> optimized = optimized_trajectory(input.recording);
  input.ate_live_m = ate_of(dataset, live_trajectory(input.recording));
  input.ate_final_m = ate_of(dataset, optimized);
  if (!optimized.empty())
    check(evaluation::write_trajectory_plot(
        folder / "trajectory.png",
        {truth_of(dataset), optimized, input.options.dataset.lexically_normal().filename().string()}));
  if (std::filesystem::exists(folder / "map.ot")) write_map_image(folder, input.map_description, optimized);
  const auto summary = summarize(input);
  write_result(folder / "summary.json", messages::to_text(summary, 2) + '\n');
  print_main_figures(summary);
}

}  // namespace rds::run
