// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/figures/metrics.hpp"

#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>

namespace rds::viewer {
namespace {

using ::testing::HasSubstr;

std::string example() {
  SceneFigures scene;
  scene.inliers = 231;
  FrameTimes times;
  for (const double seconds : {0.004, 0.012, 0.4, 3.0}) times.add(seconds);
  ServiceTable services;
  services.take(
      "rds-tracker",
      figures_of(0, "",
                 {{"cpu [s]", "5"}, {"track p50 [ms]", "9"}, {"track p99 [ms]", "20"}, {"dropped a/b", "7"}}),
      100);
  services.take("rds-\"odd\\\"", figures_of(2, "", {{"rejected a/b: invalid", "1"}}), 100);
  return metrics_text(scene, times, services, 101);
}

TEST(Metrics, AreInPrometheusForm) {
  static const std::regex kSample(
      R"re([a-z_]+(\{[a-z]+="([^"\\]|\\.)*"(,[a-z]+="([^"\\]|\\.)*")*\})? [-+0-9.einf]+)re");
  std::istringstream lines(example());
  std::set<std::string> begun;
  std::string current;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("# HELP ")) continue;
    if (line.starts_with("# TYPE ")) {
      current = line.substr(7, line.find(' ', 7) - 7);
      EXPECT_TRUE(begun.insert(current).second) << current << " twice";
      continue;
    }
    EXPECT_TRUE(std::regex_match(line, kSample)) << line;
    EXPECT_TRUE(line.starts_with(current)) << line;
  }
  EXPECT_GE(begun.size(), 20U);
}

TEST(Metrics, TellWhatTheServicesSay) {
  const std::string text = example();
  for (const char* line :
       {"rds_inliers 231\n", "rds_service_up{service=\"rds-tracker\"} 1\n",
        "rds_service_cpu_seconds_total{service=\"rds-tracker\"} 5\n",
        "rds_stage_seconds{service=\"rds-tracker\",stage=\"track\",quantile=\"0.99\"} 0.02\n",
        "rds_dropped_messages_total{service=\"rds-tracker\",topic=\"a/b\"} 7\n",
        "rds_service_up{service=\"rds-\\\"odd\\\\\\\"\"} 0\n"})
    EXPECT_THAT(text, HasSubstr(line));
}

TEST(Metrics, HistogramCountsBelowEachBound) {
  const std::string text = example();
  for (const char* line :
       {"rds_frame_seconds_bucket{le=\"0.005\"} 1\n", "rds_frame_seconds_bucket{le=\"0.015\"} 2\n",
        "rds_frame_seconds_bucket{le=\"1\"} 3\n", "rds_frame_seconds_bucket{le=\"+Inf\"} 4\n",
        "rds_frame_seconds_count 4\n", "rds_frame_seconds_sum 3.416\n"})
    EXPECT_THAT(text, HasSubstr(line));
}

}  // namespace
}  // namespace rds::viewer
