// SPDX-License-Identifier: Apache-2.0
// A subscriber that joins in the middle rebuilds the map from full map and deltas: the mapper's own tree, bit
// for bit.
#include <list>

#include <gmock/gmock.h>

#include "common/bus/participant.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "services/mapper/io/map_files.hpp"
#include "tests/integration/run_support.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/map_reader.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;

constexpr int kDomain = 24;

struct Reach {
  std::string name;
  bool network = false;              // `rds run --network`
  std::vector<bus::Vendor> vendors;  // of the run, then of further readers
};

void PrintTo(const Reach& reach, std::ostream* out) {
  *out << reach.name;
}

std::vector<Reach> reaches() {
  std::vector<Reach> all;
  for (const bool network : {false, true}) {
    const std::string name = network ? "network" : "loopback";
    all.push_back({name, network, {bus::Vendor::kFastDds, bus::Vendor::kCycloneDds}});
#if RDS_HAS_ZENOH
    all.push_back({name + "_zenoh", network, {bus::Vendor::kZenoh}});
#endif
  }
  return all;
}

/// A reader of the map on a bus of its own.
struct Reader {
  Reader(bus::Vendor vendor, bool loopback_only)
      : bus(bus::Participant::create(
            {.vendor = vendor, .domain = kDomain, .node_name = "reader", .loopback_only = loopback_only})) {}
  std::unique_ptr<bus::Participant> bus;
  MapReader map{*bus};
};

class LateJoiner : public testing::TestWithParam<Reach> {
 protected:
  static std::vector<std::string> command(const std::filesystem::path& place) {
    std::vector<std::string> line{rds(),          "run",
                                  "--dataset",    (place / "data").string(),
                                  "--out",        (place / "out").string(),
                                  "--domain",     std::to_string(kDomain),
                                  "--bus",        bus::name_of(GetParam().vendors.front()),
                                  "--no-dynamics"};
    if (GetParam().network) line.emplace_back("--network");
    return line;
  }
};

TEST_P(LateJoiner, RebuildsTheMappersTreeFromFullMapAndDeltasOverEachBus) {
  RDS_REQUIRE_SHARED("data/7scenes_kitchen");
  const TemporaryFolder place;
  make_excerpt(shared() / "data/7scenes_kitchen", place / "data", 150);
  Process process(command(place.path()));
  ASSERT_TRUE(process.wait_for_output("frame 6", 60s)) << process.standard_error();  // in the middle
  std::list<Reader> readers;
  for (const bus::Vendor vendor : GetParam().vendors) readers.emplace_back(vendor, !GetParam().network);
  EXPECT_EQ(process.wait(120s), 0) << process.standard_error();
  const auto saved = mapper::read_tree(place / "out" / "map.ot");
  ASSERT_TRUE(saved) << saved.error();
  for (const Reader& reader : readers) {
    EXPECT_TRUE(reader.map.bytes() == mapper::to_bytes(**saved));
    for (const auto& endpoint : reader.bus->statistics()) EXPECT_GT(endpoint.messages, 0U) << endpoint.topic;
  }
}

INSTANTIATE_TEST_SUITE_P(Over, LateJoiner, testing::ValuesIn(reaches()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace rds::test
