// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/status/service_report.hpp"

#include <sstream>

#include <gmock/gmock.h>

#include "common/service/presence.hpp"

namespace rds::tools {
namespace {

namespace Role = rds_msgs::msg::ServiceStatus_Constants;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using Clock = service::Peers::Clock;

const Clock::time_point kNow = Clock::time_point() + std::chrono::hours(1);
const std::vector<std::string> kMapper{"rds-mapper"};

service::Peer peer(std::uint64_t instance, std::uint8_t role = Role::ACTIVE) {
  service::Peer peer;
  peer.status.service("rds-mapper");
  peer.status.instance(instance);
  peer.status.role(role);
  peer.status.version("0.1.0");
  peer.heard = kNow - std::chrono::milliseconds(800);
  return peer;
}

std::vector<std::string> problems(const std::vector<service::Peer>& present) {
  return report_on(present, kMapper, kNow).problems;
}

TEST(ServiceReport, OneActiveServiceIsWell) {
  EXPECT_THAT(problems({peer(1)}), IsEmpty());
}

TEST(ServiceReport, DroppedMessagesAreNoFault) {
  auto warned = peer(1);
  warned.status.level(service::kWarn);
  EXPECT_THAT(problems({warned}), IsEmpty());
}

TEST(ServiceReport, NamesWhoIsMissing) {
  EXPECT_THAT(problems({}), ElementsAre(HasSubstr("rds-mapper is not there")));
}

TEST(ServiceReport, SaysWhatAServiceSaysOfItself) {
  auto hung = peer(0xABCDEF0123456789);
  hung.status.level(service::kError);
  hung.status.message("the worker has been silent for 7 s\x1B[2J");
  EXPECT_THAT(problems({hung}),
              ElementsAre("rds-mapper (abcdef01): the worker has been silent for 7 s\\x1B[2J"));
}

TEST(ServiceReport, SeesAProcessThatSaysNothingAnyMore) {
  auto stopped = peer(1);
  stopped.heard = kNow - std::chrono::seconds(4);
  EXPECT_THAT(problems({stopped}), ElementsAre(HasSubstr("has said nothing for 4 s")));
}

TEST(ServiceReport, TwoOfAKindAreOneTooMany) {
  EXPECT_THAT(problems({peer(1), peer(2, Role::STANDBY)}),
              ElementsAre("rds-mapper is there 2 times, 1 of them active"));
}

TEST(ServiceReport, AStandByAloneDoesNotWork) {
  EXPECT_THAT(problems({peer(1, Role::STANDBY)}), ElementsAre("rds-mapper is there as stand-by alone"));
}

TEST(ServiceReport, LooksForNothingInServicesThatAreNotAskedFor) {
  auto other = peer(2);
  other.status.service("rds-tracker");
  other.status.level(service::kError);
  EXPECT_THAT(problems({peer(1), other}), IsEmpty());
}

TEST(ServiceReport, NamesAreTakenAsPeopleWriteThem) {
  EXPECT_EQ(service_name("tracker"), "rds-tracker");
  EXPECT_EQ(service_name("loop_closer"), "rds-loop-closer");
  EXPECT_EQ(service_name("rds-mapper"), "rds-mapper");
}

TEST(ServiceReport, TableHasOneLinePerServiceAndPerMessageWhateverTheTextsHold) {
  auto odd = peer(2);
  odd.status.message("two\nlines");
  const auto table = as_table(report_on({peer(1), odd}, kMapper, kNow));
  EXPECT_EQ(std::ranges::count(table, '\n'), 4) << table;
  EXPECT_THAT(table, HasSubstr("00000000 active"));
  EXPECT_THAT(table, EndsWith("rds-mapper (00000000): two\\x0Alines\n"));
}

/// As a service publishes it.
diagnostic_msgs::msg::DiagnosticArray diagnostics_of(
    const std::vector<std::pair<std::string, std::string>>& figures) {
  diagnostic_msgs::msg::DiagnosticArray report;
  auto& status = report.status().emplace_back();
  for (const auto& [key, value] : figures) {
    auto& pair = status.values().emplace_back();
    pair.key(key);
    pair.value(value);
  }
  return report;
}

TEST(ServiceReport, TableSaysWhatEachLacksIn120Columns) {
  TransfersHeard heard;
  heard.take(diagnostics_of({{"instance", "00000000000000ff"},
                             {"transfer items lacking", "12"},
                             {"transfer round trip us", "3456"},
                             {"transfer link kbit_s", "39700"}}));
  heard.take(diagnostics_of({{"instance", "0000000000000001"}, {"transfer items lacking", "many"}}));
  auto report = report_on({peer(1), peer(255)}, kMapper, kNow);
  for (service::Peer& service : report.services) service.status.machine("server-room-2");
  report.transfers = heard.figures();
  std::istringstream table(as_table(report));
  std::vector<std::string> lines;
  for (std::string line; std::getline(table, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 3U);
  for (const std::string& line : lines) EXPECT_LE(line.size(), 120U) << line;
  EXPECT_THAT(lines[0], HasSubstr("lacks rtt [ms] link [Mbit/s] level"));
  EXPECT_THAT(lines[1], EndsWith("    -        -             - ok"));
  EXPECT_THAT(lines[2], EndsWith("   12      3.5          39.7 ok"));
  const auto json = as_json(report);
  EXPECT_TRUE(json["services"][0]["transfer"].is_null());
  EXPECT_EQ(json["services"][1]["transfer"]["lacking"], 12);
}

TEST(ServiceReport, JsonSaysTheSame) {
  const auto json = as_json(report_on({peer(1, Role::STANDBY)}, kMapper, kNow));
  EXPECT_FALSE(json["well"]);
  EXPECT_EQ(json["services"][0]["instance"], "0000000000000001");
  EXPECT_EQ(json["services"][0]["role"], "stand-by");
  EXPECT_EQ(json["problems"].size(), 1U);
}

}  // namespace
}  // namespace rds::tools
