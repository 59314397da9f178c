// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "common/image/recording.hpp"
#include "tools/rds/run/results/summary.hpp"

namespace rds::run {

/// Writes everything of a run that its services have not written: trajectories, tables, pictures,
/// summary.json (last), and prints the summary's main figures.
///
/// @param folder  already holds what the mapper saved (map.ot, objects.json, grid.*), if it did.
/// @throws std::runtime_error naming the file that cannot be written.
void write_all_results(SummaryInput input, const image::Recording& dataset,
                       const std::filesystem::path& folder);

}  // namespace rds::run
