// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/topic/topic_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rds::tools {
namespace {
using testing::HasSubstr;

std::vector<Arrival> every_10_ms(std::size_t count, std::size_t bytes) {
  std::vector<Arrival> arrivals;
  for (std::size_t i = 0; i < count; ++i)
    arrivals.push_back({nullptr, bytes, Clock::time_point(std::chrono::milliseconds(10 * i))});
  return arrivals;
}

TEST(TopicReport, NamesTypesAsRosDoes) {
  EXPECT_EQ(ros_type_name("nav_msgs::msg::dds_::Odometry_"), "nav_msgs/msg/Odometry");
  EXPECT_EQ(ros_type_name("something_else"), "something_else");
}

TEST(TopicReport, CountsEndpointsByTopicAndType) {
  const auto topics = summarise({{"b", "p::msg::dds_::X_", true},
                                 {"a", "p::msg::dds_::X_", false},
                                 {"b", "p::msg::dds_::X_", true},
                                 {"b", "p::msg::dds_::Y_", false}});
  ASSERT_EQ(topics.size(), 3U);
  EXPECT_EQ(topics[0].topic, "a");
  EXPECT_EQ(topics[1].publishers, 2);
  EXPECT_EQ(topics[2].type, "p/msg/Y");
}

TEST(TopicReport, CutsLongLists) {
  const nlohmann::ordered_json message{{"a", {1, 2, 3, 4}}, {"b", {{"c", {5, 6}}}}};
  EXPECT_EQ(shortened(message, 2).dump(), R"({"a":[1,2,"… 4 values"],"b":{"c":[5,6]}})");
  EXPECT_EQ(shortened(message, 4), message);
}

TEST(TopicReport, GivesRateAndBandwidth) {
  EXPECT_THAT(rate_report(every_10_ms(101, 1)), HasSubstr("100.00 Hz, 101 messages"));
  EXPECT_THAT(rate_report(every_10_ms(101, 1)), HasSubstr("median 10.00"));
  EXPECT_THAT(bandwidth_report(every_10_ms(11, 20000)),
              HasSubstr("2.00 MB/s, 11 messages, size: min 20.00 kB"));
  EXPECT_THAT(rate_report(every_10_ms(1, 1)), HasSubstr("needs two"));
  EXPECT_THAT(bandwidth_report({}), HasSubstr("needs two"));
}

}  // namespace
}  // namespace rds::tools
