// SPDX-License-Identifier: Apache-2.0
// Two readers of the map on a machine behind a slow link.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/hosts/maps/map_trial.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

std::vector<MapRow> rows() {
  std::vector<MapRow> rows;
  for (const bus::Vendor vendor : {bus::Vendor::kFastDds, bus::Vendor::kCycloneDds})
    for (const SlowReaders readers : {SlowReaders::kNone, SlowReaders::kTopics, SlowReaders::kTransfer})
      rows.push_back({.vendor = vendor, .readers = readers});
  return rows;
}

std::string name_of(const testing::TestParamInfo<MapRow>& row) {
  return row.param.label();
}

class HostsMapReaders : public testing::TestWithParam<MapRow> {};
TEST_P(HostsMapReaders, AreBehindASlowLink) {
  if (const auto reason = HostNetwork::why_not(); !reason.empty()) GTEST_SKIP() << reason;
  const std::filesystem::path out = std::filesystem::path(RDS_HOSTS_DIR) / ("maps_" + GetParam().label());
  std::filesystem::remove_all(out);
  std::filesystem::create_directories(out);
  const MapFigures figures = MapTrial(GetParam(), recording_with_people().folder, out).run();
  fmt::print("{}\n", to_line(GetParam(), figures));
}
INSTANTIATE_TEST_SUITE_P(Each, HostsMapReaders, testing::ValuesIn(rows()), name_of);

}  // namespace
}  // namespace rds::test
