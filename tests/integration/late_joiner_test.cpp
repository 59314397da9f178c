// SPDX-License-Identifier: Apache-2.0
// A subscriber that joins in the middle rebuilds the map from full map and deltas: the mapper's own tree, bit
// for bit.
#include <gmock/gmock.h>

#include "common/bus/participant.hpp"
#include "services/mapper/io/map_files.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "tests/integration/run_support.hpp"
#include "tests/support/map_reader.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;

constexpr int kDomain = 24;

/// With `rds run --network` or without.
class LateJoiner : public testing::TestWithParam<bool> {
 protected:
  static std::unique_ptr<bus::Participant> join(bus::Vendor vendor) {
    return bus::Participant::create(
        {.vendor = vendor, .domain = kDomain, .node_name = "reader", .loopback_only = !GetParam()});
  }
  static std::vector<std::string> command(const std::filesystem::path& place) {
    std::vector<std::string> line{rds(),          "run",
                                  "--dataset",    (place / "data").string(),
                                  "--out",        (place / "out").string(),
                                  "--domain",     std::to_string(kDomain),
                                  "--no-dynamics"};
    if (GetParam()) line.emplace_back("--network");
    return line;
  }
};

TEST_P(LateJoiner, RebuildsTheMappersTreeFromFullMapAndDeltasOverEitherBus) {
  RDS_REQUIRE_SHARED("data/7scenes_kitchen");
  const TemporaryFolder place;
  make_excerpt(shared() / "data/7scenes_kitchen", place / "data", 300);
  Process process(command(place.path()));
  ASSERT_TRUE(process.wait_for_output("frame 6", 60s)) << process.standard_error();  // in the middle
  const auto fast_bus = join(bus::Vendor::kFastDds);
  const auto cyclone_bus = join(bus::Vendor::kCycloneDds);
  MapReader fast(*fast_bus);
  MapReader cyclone(*cyclone_bus);
  EXPECT_EQ(process.wait(120s), 0) << process.standard_error();
  const auto saved = mapper::read_tree(place / "out" / "map.ot");
  ASSERT_TRUE(saved) << saved.error();
  const auto expected = mapper::to_bytes(**saved);
  EXPECT_TRUE(fast.bytes() == expected);
  EXPECT_TRUE(cyclone.bytes() == expected);
  for (const auto& bus : {fast_bus.get(), cyclone_bus.get()})
    for (const auto& endpoint : bus->statistics()) EXPECT_GT(endpoint.messages, 0U) << endpoint.topic;
}

INSTANTIATE_TEST_SUITE_P(Reach, LateJoiner, testing::Bool(),
                         [](const auto& test_case) { return test_case.param ? "network" : "loopback"; });

}  // namespace
}  // namespace rds::test
