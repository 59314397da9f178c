// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/faults/recordings.hpp"

namespace rds::test {

/// A recording, and the same without people.
struct RecordingPair {
  std::filesystem::path dataset;
  std::filesystem::path background;  // empty: nobody walks in the recording
};

/// What became of a row. Written beside its results, for the rows that are compared with it.
struct HostFigures {
  std::size_t frames = 0;     // sent by the camera
  std::size_t localized = 0;  // with a pose
  std::size_t keyframes = 0;  // that the tracker made
  std::size_t answered = 0;   // by boxes that arrived at A
  double p50_ms = 0;          // from a keyframe to its boxes
  double p95_ms = 0;
  double longest_gap_s = 0;  // between tracking states
  double ate_live_m = 0;
  double ate_final_m = 0;
  double recall = 0;  // of the map that C has saved
  double residue = 0;
  std::size_t missing = 0;          // keyframes that the mapper lacks at the end
  double link_bytes = 0;            // that A sent to its link while the camera ran, per keyframe
  double reader_bytes = 0;          // of them to the reader that took most, per keyframe
  double repeats = 0;               // chunks asked for again, per chunk that arrived
  double idle_kbit_s = 0;           // that reach a host where nothing runs
  double p99_total_ms = 0;          // of the tracker, for a frame
  std::vector<std::string> faults;  // sentences: what services did not do

  [[nodiscard]] double share_answered() const {
    return keyframes == 0 ? 0 : static_cast<double>(answered) / static_cast<double>(keyframes);
  }
};

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HostFigures, frames, localized, keyframes, answered, p50_ms, p95_ms,
                                   longest_gap_s, ate_live_m, ate_final_m, recall, residue, missing,
                                   link_bytes, reader_bytes, repeats, idle_kbit_s, p99_total_ms, faults)

/// The value below which this share of them lies; 0 of none.
double quantile(const std::vector<double>& sorted, double share);

/// Bytes and repeats of the transfer to readers on other machines, as these tell in their status.
/// @param statuses  answers to the command `status`, by service.
void add_transfer(const std::map<std::string, std::string>& statuses, HostFigures& figures);

/// The path and the map, compared with truth.
/// @param out  results of a row; without a map there are no figures of it. @param seen_by  those whose
/// keyframes tell what can be in the map.
/// @throws std::runtime_error with one sentence if they cannot be scored.
void add_scores(const RecordingPair& recording, const std::filesystem::path& out,
                const std::filesystem::path& seen_by, HostFigures& figures);

/// A line of the table. In parentheses what one machine has.
std::string to_line(const std::string& label, const HostFigures& figures, const HostFigures& one_machine);

}  // namespace rds::test
