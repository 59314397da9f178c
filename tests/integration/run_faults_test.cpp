// SPDX-License-Identifier: Apache-2.0
// What a run does when a service dies, the user stops it, or services stand alone.
#include <csignal>
#include <thread>

#include <gmock/gmock.h>

#include "common/bus/participant.hpp"
#include "common/commander/commander.hpp"
#include "tests/integration/run_support.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::vector<std::string> kServices{"rds-tracker", "rds-detector", "rds-transformer", "rds-mapper",
                                         "rds-loop-closer"};

class KilledService : public ::testing::TestWithParam<std::string> {};

TEST_P(KilledService, IsStartedAgainAndTheRunGoesOn) {
  const TemporaryFolder place;
  make_excerpt(recording_of_a_room().folder, place / "data", 120);
  Process process({rds(), "run", "--dataset", (place / "data").string(), "--out", (place / "out").string()});
  ASSERT_TRUE(process.wait_for_output("frame", 60s));
  std::this_thread::sleep_for(2s);
  const auto victims = children(process.pid(), GetParam());
  ASSERT_EQ(victims.size(), 1U);
  ASSERT_EQ(kill(victims.front(), SIGKILL), 0);
  EXPECT_EQ(process.wait(120s), 1) << "a run with a fault must say so";
  EXPECT_THAT(process.standard_error(), HasSubstr(GetParam() + " ended with status 137"));
  const auto summary = nlohmann::json::parse(read_text(place / "out" / "summary.json"));
  EXPECT_EQ(summary["processes"][GetParam()]["restarts"], 1);
  EXPECT_EQ(summary["frames"]["played"], 120);
  EXPECT_GT(summary["frames"]["tracked"].get<int>(), GetParam() == "rds-tracker" ? 40 : 110);
  EXPECT_GT(summary["detector"]["lag_ms"]["median"].get<double>(), 0);
  EXPECT_LT(summary["detector"]["lag_ms"]["p99"].get<double>(), 1000);
  EXPECT_GT(summary["map"]["delay_s"]["median"].get<double>(), 0);
}

INSTANTIATE_TEST_SUITE_P(Each, KilledService, ::testing::ValuesIn(kServices),
                         [](const auto& each) { return each.param.substr(4, 4); });

/// What was under way in it is lost, and nobody waits for that for long.
TEST(KilledMapper, DoesNotHoldALockstepRunUp) {
  const TemporaryFolder place;
  make_excerpt(recording_of_a_room().folder, place / "data", 240);
  Process process({rds(), "run", "--dataset", (place / "data").string(), "--out", (place / "out").string(),
                   "--rate", "max"});
  ASSERT_TRUE(process.wait_for_output("frame", 60s));
  const auto victims = children(process.pid(), "rds-mapper");
  ASSERT_EQ(victims.size(), 1U);
  ASSERT_EQ(kill(victims.front(), SIGKILL), 0);
  EXPECT_EQ(process.wait(100s), 1) << "a run with a fault must say so";
  const auto summary = nlohmann::json::parse(read_text(place / "out" / "summary.json"));
  EXPECT_EQ(summary["processes"]["rds-mapper"]["restarts"], 1);
  EXPECT_EQ(summary["frames"]["tracked"], 240);
}

TEST(PausedServices, DoNotHoldALockstepRunUp) {
  const TemporaryFolder place;
  make_excerpt(recording_of_a_room().folder, place / "data", 300);
  Process process({rds(), "run", "--dataset", (place / "data").string(), "--out", (place / "out").string(),
                   "--rate", "max", "--domain", "27"});
  const auto bus = bus::Participant::create({.domain = 27, .node_name = "pauser", .loopback_only = true});
  commander::Commander commander(*bus);
  ASSERT_TRUE(process.wait_for_output("frame", 60s));
  while (commander.ask_status(kServices.size(), {}, 300ms).size() < kServices.size())
    ASSERT_TRUE(process.running());
  for (const char* service : {"rds-detector", "rds-loop-closer"}) {
    const auto reply = commander.ask(service, "pause", "", {}, 20s);
    ASSERT_TRUE(reply && reply->success) << service;
  }
  EXPECT_EQ(process.wait(120s), 0) << process.standard_error();
  EXPECT_THAT(read_text(place / "out" / "log" / "rds-tracker.log"),
              Not(HasSubstr("goes on without an answer")));
}

TEST(StoppedRun, EndsWithinThreeSecondsAndLeavesNothing) {
  const TemporaryFolder place;
  Process process(
      {rds(), "run", "--dataset", recording_of_a_room().folder.string(), "--out", (place / "out").string()});
  ASSERT_TRUE(process.wait_for_output("frame", 60s));
  std::vector<pid_t> services;
  for (const std::string& name : kServices)
    for (const pid_t pid : children(process.pid(), name)) services.push_back(pid);
  EXPECT_EQ(services.size(), kServices.size());
  process.send(SIGINT);
  EXPECT_EQ(process.wait(3s), 1);
  for (const pid_t pid : services) EXPECT_NE(kill(pid, 0), 0) << pid << " is still there";
  EXPECT_TRUE(is_empty(place.path()));
}

class LoneService : public ::testing::TestWithParam<std::string> {};

TEST_P(LoneService, StartsWithoutTheOthersAndStopsWhenAsked) {
  for (const std::string& bus : all_vendor_names()) {
    Process process(
        {std::string(RDS_BIN_DIR) + "/" + GetParam(), "--bus", bus, "--domain", "25", "--loopback"});
    ASSERT_TRUE(process.wait_for_output("version", 20s)) << bus << process.standard_error();
    std::this_thread::sleep_for(500ms);
    EXPECT_TRUE(process.running());
    process.send(SIGTERM);
    EXPECT_EQ(process.wait(3s), 0) << bus << process.standard_error();
  }
}

INSTANTIATE_TEST_SUITE_P(Each, LoneService, ::testing::ValuesIn(kServices),
                         [](const auto& each) { return each.param.substr(4, 4); });

}  // namespace
}  // namespace rds::test
