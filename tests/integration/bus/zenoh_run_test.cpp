// SPDX-License-Identifier: Apache-2.0
// A stranger reads the map of a run over Zenoh. That a run gives the same bytes on every bus: RecordedRun.
#include <map>

#include <gtest/gtest.h>

#include "common/bus/participant.hpp"
#include "common/commander/commander.hpp"
#include "services/mapper/core/octree/label_table.hpp"
#include "services/mapper/io/map_files.hpp"
#include "tests/integration/run_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using Counts = std::map<mapper::Rgb, std::size_t>;

/// Occupied voxels of each colour.
Counts count_colors(const octomap::ColorOcTree& tree) {
  Counts counts;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    const auto color = leaf->getColor();
    counts[{color.r, color.g, color.b}] += std::size_t{1} << 3 * (tree.getTreeDepth() - leaf.getDepth());
  }
  return counts;
}

/// What docs/examples/python/zenoh_labels.py says of a mapper that has loaded this map: voxels of each label.
nlohmann::json counts_of_a_stranger(const fs::path& saved_map) {
  constexpr int kDomain = 26;
  const auto domain = std::to_string(kDomain);
  Process mapper({(fs::path(rds()).parent_path() / "rds-mapper").string(), "--bus", "zenoh", "--domain",
                  domain, "--loopback"},
                 {{"RDS_MAPS_DIR", saved_map.parent_path().string()}});
  const auto bus = bus::Participant::create(
      {.vendor = bus::Vendor::kZenoh, .domain = kDomain, .node_name = "commander", .loopback_only = true});
  commander::Commander commander(*bus);
  for (int i = 0; i < 60 && commander.ask_status(1, {}, 500ms).empty(); ++i) {
  }
  const auto reply = commander.ask("rds-mapper", "load", saved_map.filename(), {}, 10s);
  EXPECT_TRUE(reply && reply->success) << (reply ? reply->message : "no answer");
  Process stranger({RDS_ZENOH_PYTHON, "-B", RDS_SOURCE_DIR "/docs/examples/python/zenoh_labels.py",
                    RDS_SOURCE_DIR "/idl/rds_msgs/msg", domain});
  if (!stranger.wait_for_output("\n", 60s)) {
    ADD_FAILURE() << "the stranger says nothing: " << stranger.standard_error();
    return {};
  }
  const std::string said = stranger.standard_output();
  return nlohmann::json::parse(said.substr(0, said.find('\n')));
}

void expect_that_a_stranger_reads(const fs::path& saved_map) {
  const auto tree = mapper::read_tree(saved_map / "map.ot");
  ASSERT_TRUE(tree) << tree.error();
  Counts expected = count_colors(**tree);  // labels are told by colours there
  const auto labels = counts_of_a_stranger(saved_map);
  EXPECT_GT(labels.size(), 2U);
  std::size_t sum = 0;
  for (const auto& [label, count] : labels.items()) {
    sum += count.get<std::size_t>();
    if (label == "no object") continue;
    EXPECT_EQ(count, expected[mapper::label_color(label)]) << label;
  }
  std::size_t occupied = 0;
  for (const auto& [color, count] : expected) occupied += count;
  EXPECT_EQ(sum, occupied);
}

TEST(ZenohRun, MakesAMapThatAStrangerReads) {
  const TemporaryFolder place;
  const auto dataset = recording_with_people().folder;
  const ProcessResult result =
      run(dataset, place / "zenoh", {"--rate", "max", "--frames", "90", "--bus", "zenoh"});
  ASSERT_EQ(result.status, 0) << result.standard_error;
  if (!fs::exists(RDS_ZENOH_PYTHON))
    GTEST_SKIP() << "no Python packages of zenoh_requirements.txt (tools/setup.sh --ros)";
  expect_that_a_stranger_reads(place / "zenoh");
}

TEST(ZenohRun, MeetsNoDds) {
  const TemporaryFolder place;
  const auto dataset = recording_of_a_room().folder;
  const ProcessResult result = run(dataset, place / "out", {"--bus", "tracker=zenoh"});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.standard_error,
            "--bus: expected zenoh for all processes or for none, it does not meet DDS\n");
}

}  // namespace
}  // namespace rds::test
