// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/services/fleet.hpp"

#include <csignal>
#include <thread>

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.hpp"

namespace rds::run {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class FleetTest : public ::testing::Test {
 protected:
  ServiceCommand shell(const std::string& script) const {
    return {"service", {"/bin/sh", "-c", script}, place_ / "log"};
  }
  template <class Condition>
  static bool watch_until(Fleet& fleet, Condition condition) {
    for (int i = 0; i < 200 && !condition(); ++i) {
      fleet.watch();
      std::this_thread::sleep_for(5ms);
    }
    return condition();
  }
  test::TemporaryFolder place_;
};

TEST_F(FleetTest, StopsServicesThatObeyAndKillsThoseThatDoNot) {
  Fleet obedient({shell("trap 'exit 0' TERM; while :; do sleep 0.01; done")});
  std::this_thread::sleep_for(100ms);
  obedient.stop(1000ms);
  EXPECT_TRUE(obedient.healthy());
  Fleet stubborn({shell("trap '' TERM; while :; do sleep 0.01; done")});
  std::this_thread::sleep_for(100ms);
  stubborn.stop(200ms);
  EXPECT_THAT(stubborn.usage().at("service").failures, ElementsAre(128 + SIGKILL));
}

TEST_F(FleetTest, StartsADeadServiceAgainAndIsNotHealthyThen) {
  const auto flag = (place_ / "flag").string();
  Fleet fleet({shell("if [ -e " + flag + " ]; then sleep 60; fi; touch " + flag + "; exit 7")});
  EXPECT_TRUE(watch_until(fleet, [&] { return fleet.usage().at("service").restarts == 1; }));
  EXPECT_TRUE(fleet.alive("service"));
  EXPECT_FALSE(fleet.healthy());
  EXPECT_THAT(fleet.usage().at("service").failures, ElementsAre(7));
  fleet.stop(500ms);
}

TEST_F(FleetTest, GivesUpAServiceThatKeepsDying) {
  Fleet fleet({shell("exit 1")});
  EXPECT_TRUE(watch_until(
      fleet, [&] { return !fleet.alive("service") && fleet.usage().at("service").failures.size() > 5; }));
}

TEST_F(FleetTest, ReportsWhatAServiceSaidThatRefusedToStart) {
  Fleet fleet({shell("echo tracker.yaml: speed: unknown key >&2; exit 2")});
  try {
    watch_until(fleet, [] { return false; });
    FAIL() << "no failure reported";
  } catch (const Fleet::StartupFailure& e) {
    EXPECT_STREQ(e.what(), "tracker.yaml: speed: unknown key");
  }
}

TEST_F(FleetTest, CountsWhatServicesUsed) {
  Fleet fleet({shell("i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done; sleep 60")});
  std::this_thread::sleep_for(300ms);
  fleet.stop(500ms);
  EXPECT_GT(fleet.usage().at("service").cpu_s, 0.01);
  EXPECT_GT(fleet.usage().at("service").peak_bytes, 100'000U);
}

}  // namespace
}  // namespace rds::run
