// SPDX-License-Identifier: Apache-2.0
#include "tests/hosts/hosts_check.hpp"

#include <map>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/hosts/hosts_trial.hpp"
#include "tests/support/disturbed_dataset.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

namespace fs = std::filesystem;

constexpr double kMinLocalized = 0.9;  // of the frames, on one machine
constexpr double kMaxGapS = 0.1;       // longer than one machine's
constexpr double kMaxRepeats = 0.1;
constexpr double kMaxReaderBytes = 0.2e6;  // a keyframe
constexpr double kTurnS = 15;
constexpr double kMaxIdleKbitS = 10;
constexpr double kMaxLinkBytes = 0.8e6;  // a keyframe; one raw keyframe or camera frame has 1.5 MB
constexpr double kMaxOfBeside = 1.1;     // p99 of a frame, of that without a network
const std::string kFiguresFile = "figures.json";

fs::path results_of(const std::string& label) {
  return fs::path(RDS_HOSTS_DIR) / label;
}

/// Those of the first turn, in which pictures have their own stamps.
void link_masks(const fs::path& from, const fs::path& to) {
  std::map<double, fs::path> masks;
  for (const auto& mask : fs::directory_iterator(from)) masks[std::stod(mask.path().stem())] = mask.path();
  fs::create_directories(to);
  for (const auto& [stamp_s, mask] : masks)
    if (stamp_s <= masks.begin()->first + kTurnS) fs::create_symlink(mask, to / mask.filename());
}

RecordingPair recording_of(const Row& row, const fs::path& place) {
  const TestRecording people = recording_with_people();
  const RecordingPair whole{
      people.folder, people.rendered ? rendered_recording("room_empty") : shared() / "data/7scenes_kitchen"};
  if (row.length_s == 0) return whole;
  make_to_and_fro(whole.dataset, place / "recording", 0, kTurnS, row.length_s + 1);
  make_to_and_fro(whole.background, place / "background", 0, kTurnS, row.length_s + 1);
  link_masks(whole.dataset / "masks", place / "recording" / "masks");
  return {place / "recording", place / "background"};
}

HostFigures figures_in(const fs::path& out) {
  return nlohmann::json::parse(read_text(out / kFiguresFile)).get<HostFigures>();
}

/// @param scored  whether path and map are compared with the truth, and with one machine.
HostFigures run_row(const Row& row, bool scored = true) {
  const fs::path out = results_of(row.label());
  fs::remove_all(out);
  fs::create_directories(out);
  in_own_process([&] {
    const TemporaryFolder place;
    const RecordingPair recording = recording_of(row, place.path());
    HostFigures figures = HostsTrial(row, recording.dataset, out).run();
    if (scored) add_scores(recording, out, results_of(on_one_machine(row).label()), figures);
    write_text(out / kFiguresFile, nlohmann::json(figures).dump(2));
  });
  return figures_in(out);
}

/// Those of this sitting's run on one machine, made now if there is none.
HostFigures figures_on_one_machine(const Row& row) {
  const Row one_machine = on_one_machine(row);
  const fs::path out = results_of(one_machine.label());
  return fs::exists(out / kFiguresFile) ? figures_in(out) : run_row(one_machine);
}

/// What does not depend on how fast the machine is.
void expect_counts(const Row& row, const HostFigures& figures) {
  EXPECT_THAT(figures.faults, testing::IsEmpty());
  EXPECT_GE(figures.share_answered(), row.bounds.answered);
  if (row.absence) {
    EXPECT_EQ(figures.missing, 0U);
  }
  EXPECT_LE(figures.repeats, kMaxRepeats);
  EXPECT_LE(figures.reader_bytes, kMaxReaderBytes);
}

}  // namespace

void expect_baseline(const Row& row) {
  if (const auto reason = HostNetwork::why_not(); !reason.empty()) GTEST_SKIP() << reason;
  const HostFigures figures = run_row(row);
  fmt::print("{}\n", to_line(row.label(), figures, figures));
  EXPECT_THAT(figures.faults, testing::IsEmpty());
  EXPECT_GE(static_cast<double>(figures.localized), kMinLocalized * static_cast<double>(figures.frames));
}

void expect_complete(const Row& row) {
  if (const auto reason = HostNetwork::why_not(); !reason.empty()) GTEST_SKIP() << reason;
  const HostFigures figures = run_row(row, false);
  fmt::print("{}\n", to_line(row.label(), figures, figures));
  expect_counts(row, figures);
}

void expect_row(const Row& row) {
  if (const auto reason = HostNetwork::why_not(); !reason.empty()) GTEST_SKIP() << reason;
  const HostFigures one_machine = figures_on_one_machine(row);
  const HostFigures figures = run_row(row);
  fmt::print("{}\n", to_line(row.label(), figures, one_machine));
  expect_counts(row, figures);
  EXPECT_LE(figures.p95_ms, row.bounds.p95_ms);
  EXPECT_LE(figures.longest_gap_s, one_machine.longest_gap_s + kMaxGapS);
  EXPECT_GE(figures.recall, one_machine.recall - row.bounds.map_share);
  EXPECT_LE(figures.residue, one_machine.residue + row.bounds.map_share);
  if (row.has_bystanders) {
    EXPECT_LE(figures.idle_kbit_s, kMaxIdleKbitS);
    EXPECT_LE(figures.link_bytes, kMaxLinkBytes);
  }
}

void expect_split_cores(const CoreRows& rows) {
  if (const auto reason = HostNetwork::why_not(); !reason.empty()) GTEST_SKIP() << reason;
  const HostFigures alone = run_row(rows.alone, false);
  const HostFigures split = run_row(rows.split, false);
  const HostFigures beside = run_row(rows.beside, false);
  const HostFigures shared = run_row(rows.shared, false);
  fmt::print(
      "{}: p99 of a frame {:.1f} ms split, {:.1f} ms beside, {:.1f} ms shared, {:.1f} ms alone; medians of "
      "answers {:.0f}, "
      "{:.0f} and {:.0f} ms\n",
      bus::name_of(rows.split.vendor), split.p99_total_ms, beside.p99_total_ms, shared.p99_total_ms,
      alone.p99_total_ms, split.p50_ms, beside.p50_ms, shared.p50_ms);
  EXPECT_THAT(split.faults, testing::IsEmpty());
  EXPECT_LE(split.p99_total_ms, kMaxOfBeside * beside.p99_total_ms);
}

}  // namespace rds::test
