// SPDX-License-Identifier: Apache-2.0
// Two readers of the map on a machine behind a slow link, against nobody there.
#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/hosts/maps/map_trial.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

constexpr double kMaxFirstS = 5;
constexpr double kMaxBehindS = 2;
constexpr double kMaxSlower = 1.05;     // the others' latency
constexpr double kClockMs = 2;          // what two runs of the same differ by, on a machine of two cores
constexpr double kMaxOfferedMbit = 5;   // by transfer: no more than the link carries
constexpr double kMaxFloodMbit = 100;   // to programs that read the topics: a tenth of what it was
constexpr double kMaxMapperCpu = 1.25;  // of what it takes without them

class HostsMapReaders : public testing::TestWithParam<bus::Vendor> {
 protected:
  static MapFigures run(SlowReaders readers) {
    const MapRow row{.vendor = GetParam(), .readers = readers};
    const std::filesystem::path out = std::filesystem::path(RDS_HOSTS_DIR) / ("maps_" + row.label());
    std::filesystem::remove_all(out);
    std::filesystem::create_directories(out);
    in_own_process([&] {
      write_text(out / "figures.json",
                 nlohmann::json(MapTrial(row, recording_with_people().folder, out).run()).dump(2));
    });
    const auto figures = nlohmann::json::parse(read_text(out / "figures.json")).get<MapFigures>();
    fmt::print("{}\n", to_line(row, figures));
    return figures;
  }
};

TEST_P(HostsMapReaders, BehindASlowLinkCostTheOthersNothing) {
  if (const auto reason = HostNetwork::why_not(); !reason.empty()) GTEST_SKIP() << reason;
  const MapFigures before = run(SlowReaders::kNone);
  const MapFigures transfer = run(SlowReaders::kTransfer);
  for (const FollowerFigures& follower : transfer.followers) {
    EXPECT_LE(follower.first_s, kMaxFirstS);
    EXPECT_LE(follower.behind_p95_s, kMaxBehindS);
  }
  EXPECT_LE(transfer.offered_mbit_s, kMaxOfferedMbit);
  const MapFigures topics = run(SlowReaders::kTopics);
  EXPECT_LE(topics.offered_mbit_s, kMaxFloodMbit);
  const MapFigures after = run(SlowReaders::kNone);
  EXPECT_LE(transfer.near_p50_ms, kMaxSlower * std::max(before.near_p50_ms, after.near_p50_ms) + kClockMs);
  EXPECT_LE(transfer.boxes_p50_ms, kMaxSlower * std::max(before.boxes_p50_ms, after.boxes_p50_ms) + kClockMs);
  EXPECT_LE(topics.mapper_cpu, kMaxMapperCpu * std::max(before.mapper_cpu, after.mapper_cpu));
}

INSTANTIATE_TEST_SUITE_P(Each, HostsMapReaders, testing::ValuesIn(kAllVendors), vendor_name);

}  // namespace
}  // namespace rds::test
