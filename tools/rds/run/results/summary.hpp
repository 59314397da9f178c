// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "tools/rds/play/player.hpp"
#include "tools/rds/run/results/recording.hpp"
#include "tools/rds/run/services/fleet.hpp"
#include "tools/rds/run/services/run_options.hpp"

namespace rds::run {

/// What summary.json is made of.
struct SummaryInput {
  const RunOptions& options;
  const Recording& recording;
  const play::PlayerReport& player;
  const std::map<std::string, ServiceUsage>& usage;
  const std::map<std::string, std::string>& status;  // by service, as the command `status` answers
  std::size_t frames_in_dataset = 0;                 // of the part that was played
  double wall_s = 0;
  std::string
      map_description;  // the mapper's answer to `finish`: JSON with up and labels; empty if there is none
  std::optional<double> ate_live_m;
  std::optional<double> ate_final_m;
};

/// frames in, tracked, lost and dropped; times; keyframes; loops; how far detector and map are behind; CPU and memory per
/// process; traffic per topic; ATE.
nlohmann::ordered_json summarize(const SummaryInput& input);

}  // namespace rds::run
