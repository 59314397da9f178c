// SPDX-License-Identifier: Apache-2.0
// Whole runs of the real processes on rendered recordings, whose truth is exact: each way of moving the
// camera with people in the picture, and a way around the room that closes a loop.
#include <optional>

#include <gmock/gmock.h>

#include "tests/integration/run_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

/// What `rds eval` must say of a recording and its twin without people.
struct RenderedFigures {
  std::string name;
  std::string bus;
  double max_ate_m;
  double min_box_recall;
  double max_residue;
  std::optional<double>
      min_static_recall;  // none where the camera stands: what aligns map and truth is loose
};

void PrintTo(const RenderedFigures& figures, std::ostream* out) {
  *out << figures.name;
}

class RenderedRun : public ::testing::TestWithParam<RenderedFigures> {};

TEST_P(RenderedRun, KeepsPeopleOutOfPoseAndMap) {
  const RenderedFigures& expected = GetParam();
  const TemporaryFolder place;
  const auto dataset = rendered_recording(expected.name);
  const ProcessResult result = run(dataset, place / "out", {"--rate", "max", "--bus", expected.bus});
  ASSERT_EQ(result.status, 0) << result.standard_error;
  const auto figures = score(dataset, place / "out", rendered_recording(expected.name + "_empty"));
  EXPECT_EQ(figures["tracked"].get<double>(), 1.0);
  EXPECT_LE(figures["ate_final"].get<double>(), expected.max_ate_m);
  EXPECT_GE(figures["box_recall"].get<double>(), expected.min_box_recall);
  EXPECT_LE(figures["residue"].get<double>(), expected.max_residue);
  if (expected.min_static_recall) {
    EXPECT_GE(figures["static_recall"].get<double>(), *expected.min_static_recall);
  }
}

INSTANTIATE_TEST_SUITE_P(Path, RenderedRun,
                         ::testing::Values(RenderedFigures{"room", "fastdds", 0.010, 0.80, 0.01, 0.97},
                                           RenderedFigures{"rpy", "cyclonedds", 0.010, 0.80, 0.02, 0.80},
                                           RenderedFigures{"halfsphere", "fastdds", 0.010, 0.80, 0.01, 0.97},
                                           RenderedFigures{"static", "cyclonedds", 0.005, 0.80, 0.02, {}}),
                         [](const auto& path) { return path.param.name; });

/// The end of the lap sees the start again.
TEST(RenderedLoop, IsJoinedThroughAllProcesses) {
  const TemporaryFolder place;
  const auto dataset = rendered_recording("loop");
  const auto out = place.path() / "joined";
  const ProcessResult result = run(dataset, out, {"--rate", "max", "--no-dynamics"});
  ASSERT_EQ(result.status, 0) << result.standard_error;
  const auto figures = score(dataset, out, dataset);
  EXPECT_GE(nlohmann::json::parse(read_text(out / "summary.json"))["loops_closed"].get<int>(), 1);
  EXPECT_GE(figures["loops_true"].get<int>(), 3);
  EXPECT_EQ(figures["loops_false"].get<int>(), 0);
  EXPECT_EQ(figures["tracked"].get<double>(), 1.0);
  EXPECT_LE(figures["ate_final"].get<double>(), 0.0045);  // .0033; .0051 where the loop is not joined
  EXPECT_LT(figures["ate_final"].get<double>(), figures["ate_live"].get<double>());
  EXPECT_GE(figures["static_recall"].get<double>(), 0.97);
  EXPECT_GE(figures["map_precision"].get<double>(), 0.99);
}

}  // namespace
}  // namespace rds::test
