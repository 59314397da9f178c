// SPDX-License-Identifier: Apache-2.0
// Whole runs of the real processes on recordings that lose the camera on the way.
#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>

#include "tests/integration/run_support.hpp"
#include "tests/support/disturbed_dataset.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

constexpr std::size_t kFindBackFrames = 10;
constexpr double kMaxErrorRatio = 1.3;   // to the undisturbed run
constexpr double kSmallErrorM = 0.010;  // … or, in a rendered room, where that has an error of some millimetres
constexpr FrameRange kDark{.first = 120, .count = 30};
constexpr std::size_t kLookedAtFrames = 220;

struct RunFigures {
  std::vector<std::string> states;  // per frame
  std::size_t poses = 0;            // lines of trajectory.txt
  double ate_final_m = 0;
};

RunFigures figures_of(const std::filesystem::path& dataset, const std::filesystem::path& out) {
  const ProcessResult result = run(dataset, out, {"--rate", "max", "--no-dynamics"});
  if (result.status != 0) throw std::runtime_error(result.standard_error);
  RunFigures figures;
  std::istringstream frames(read_text(out / "frames.csv"));
  std::string line;
  std::getline(frames, line);
  while (std::getline(frames, line)) {
    const auto comma = line.find(',') + 1;
    figures.states.push_back(line.substr(comma, line.find(',', comma) - comma));
  }
  std::istringstream trajectory(read_text(out / "trajectory.txt"));
  while (std::getline(trajectory, line)) figures.poses += line.empty() || line.front() == '#' ? 0U : 1U;
  figures.ate_final_m = score(dataset, out)["ate_final"].get<double>();
  return figures;
}

std::size_t frames_in(const RunFigures& figures, const std::string& state) {
  return static_cast<std::size_t>(std::ranges::count(figures.states, state));
}

/// TRACKING within ten frames from `first_usable` on, and to the end from there.
void expect_found_back(const RunFigures& figures, std::size_t first_usable) {
  ASSERT_GT(figures.states.size(), first_usable + kFindBackFrames);
  const auto usable = figures.states.begin() + static_cast<std::ptrdiff_t>(first_usable);
  const auto found = std::find(usable, figures.states.end(), "TRACKING");
  EXPECT_LE(found - usable, static_cast<std::ptrdiff_t>(kFindBackFrames));
  EXPECT_EQ(std::find(found, figures.states.end(), "LOST"), figures.states.end());
}

/// A frame that was not localised has no line in the trajectory.
void expect_no_invented_pose(const RunFigures& figures) {
  EXPECT_EQ(figures.poses + frames_in(figures, "LOST"), figures.states.size());
}

void expect_as_exact(const RunFigures& disturbed, const RunFigures& whole) {
  const double small_m = why_not_shared("data").empty() ? 0 : kSmallErrorM;
  EXPECT_LE(disturbed.ate_final_m, std::max(kMaxErrorRatio * whole.ate_final_m, small_m));
}

class DisturbedRun : public testing::Test {
 protected:
  RunFigures run_of(const std::string& dataset) {
    return figures_of(place / dataset, place / (dataset + "_out"));
  }
  void expect_held_then_lost(Darkened darkened, std::size_t held);
  TemporaryFolder place;
};

/// Of a second without usable pictures the first `held` frames are WEAK, the others LOST.
void DisturbedRun::expect_held_then_lost(Darkened darkened, std::size_t held) {
  if (why_not_shared("data/tum_fr1_rpy").empty())
    make_excerpt(shared() / "data/tum_fr1_rpy", place / "whole", kLookedAtFrames, 240);
  else
    make_excerpt(recording_of_a_room().folder, place / "whole", kLookedAtFrames);
  make_blacked_out(place / "whole", place / "dark", kDark, darkened);
  const RunFigures whole = run_of("whole");
  const RunFigures dark = run_of("dark");
  EXPECT_EQ(frames_in(whole, "LOST"), 0U);
  for (std::size_t i = 0; i < kDark.count; ++i)
    EXPECT_EQ(dark.states.at(kDark.first + i), i < held ? "WEAK" : "LOST") << i;
  expect_found_back(dark, kDark.first + kDark.count);
  expect_no_invented_pose(dark);
  expect_as_exact(dark, whole);
}

TEST_F(DisturbedRun, IsHeldByDepthForHalfASecondInTheDarkThenLost) {
  expect_held_then_lost(Darkened::kColor, 15);
}

TEST_F(DisturbedRun, ACoveredCameraIsLostAtOnceAndLeavesNoTrace) {
  expect_held_then_lost(Darkened::kColorAndDepth, 0);
}

TEST_F(DisturbedRun, FindsItselfAfterACut) {
  const TestRecording recording = recording_of_a_room();
  const FrameRange missing = recording.rendered ? FrameRange{200, 97} : FrameRange{250, 45};
  make_excerpt(recording.folder, place / "whole", 340);
  make_cut(place / "whole", place / "cut", missing);
  const RunFigures whole = run_of("whole");
  const RunFigures cut = run_of("cut");
  EXPECT_EQ(cut.states.size() + missing.count, whole.states.size());
  EXPECT_THAT(cut.states.at(missing.first), testing::AnyOf("RELOCALISED", "LOST"));
  expect_found_back(cut, missing.first);
  expect_no_invented_pose(cut);
  expect_as_exact(cut, whole);
}

TEST_F(DisturbedRun, FindsItselfAfterAJumpToAPlaceSeenTenSecondsAgo) {
  const TestRecording recording = recording_of_a_room();
  const double jump_s = recording.bound(14, 11.5);
  make_jump(recording.folder, place / "whole", jump_s, jump_s, jump_s);
  make_jump(recording.folder, place / "jump", jump_s, jump_s - 10, jump_s - 6);
  const RunFigures whole = run_of("whole");
  const RunFigures jump = run_of("jump");
  ASSERT_GT(jump.states.size(), whole.states.size() + 30);
  EXPECT_THAT(jump.states.at(whole.states.size()), testing::AnyOf("RELOCALISED", "LOST"));
  expect_found_back(jump, whole.states.size());
  expect_no_invented_pose(jump);
  expect_as_exact(jump, whole);
}

}  // namespace
}  // namespace rds::test
