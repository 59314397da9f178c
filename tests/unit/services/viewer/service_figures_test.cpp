// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/figures/service_figures.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace rds::viewer {
namespace {

TEST(ServiceFigures, SortsWhatDiagnosticsSay) {
  const auto figures = figures_of(1, "3 messages dropped",
                                  {{"instance", "1234"},
                                   {"role", "active"},
                                   {"cpu [s]", "12.50"},
                                   {"rss [MB]", "150.2"},
                                   {"track p50 [ms]", "9.1"},
                                   {"track p99 [ms]", "21.5"},
                                   {"keyframes waiting", "2"},
                                   {"dropped rds/map/full", "3"},
                                   {"rejected rds/boxes: invalid", "4"}});
  EXPECT_EQ(figures.level, 1);
  EXPECT_DOUBLE_EQ(figures.cpu_s, 12.5);
  EXPECT_DOUBLE_EQ(figures.resident_mb, 150.2);
  EXPECT_DOUBLE_EQ(figures.latencies.at("track").p99_ms, 21.5);
  EXPECT_DOUBLE_EQ(figures.dropped.at("rds/map/full"), 3);
  EXPECT_DOUBLE_EQ((figures.rejected.at({"rds/boxes", "invalid"})), 4);
  EXPECT_DOUBLE_EQ(figures.counts.at("keyframes waiting"), 2);
  EXPECT_EQ(figures.texts.at("role"), "active");
  EXPECT_EQ(figures.texts.at("instance"), "1234");
}

TEST(ServiceFigures, AreBounded) {
  KeyValues many;
  for (int i = 0; i < 10000; ++i) many.emplace_back("figure " + std::to_string(i), std::string(100000, '\n'));
  const auto figures = figures_of(0, std::string(100000, 'x'), many);
  EXPECT_EQ(figures.texts.size(), kMostFigures);
  EXPECT_EQ(figures.message.size(), kMostTextBytes);
  EXPECT_EQ(figures.texts.begin()->second, std::string(kMostTextBytes, '?'));
  ServiceTable table;
  for (int i = 0; i < 1000; ++i) table.take("rds-" + std::to_string(i), figures, 0);
  EXPECT_EQ(table.entries().size(), ServiceTable::kMostServices);
}

TEST(ServiceTable, TellsHowLongAgoEachWasHeard) {
  ServiceTable table;
  table.take("rds-mapper", figures_of(0, "", {{"dropped a/b", "2"}, {"dropped a/c", "3"}}), 10);
  const auto json = nlohmann::json::parse(table.to_json(12.5));
  EXPECT_DOUBLE_EQ(json["rds-mapper"]["heard_s_ago"], 2.5);
  EXPECT_DOUBLE_EQ(json["rds-mapper"]["dropped"], 5);
}

}  // namespace
}  // namespace rds::viewer
