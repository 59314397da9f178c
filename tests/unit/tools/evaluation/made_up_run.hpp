// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace rds::test {

/// Writes a small world into `folder`: `folder/background` (a wall with a box in front of it, seen from a
/// camera that goes sideways; 640×480 depth only), `folder/dataset` (the same with one person gliding
/// through, people.json, masks) and `folder/run` (what a run could have written: noisy trajectories in
/// another frame, frames.csv, predictions.jsonl, map.ot with a part of the person in it). Same bytes every
/// time.
void make_scored_run(const std::filesystem::path& folder);

}  // namespace rds::test
