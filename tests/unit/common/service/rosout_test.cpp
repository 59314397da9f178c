// SPDX-License-Identifier: Apache-2.0
#include "common/service/ros/rosout.hpp"

#include <condition_variable>
#include <mutex>
#include <vector>

#include <gmock/gmock.h>
#include <spdlog/spdlog.h>

#include "tests/support/test_domain.hpp"

namespace rds::service {
namespace {

using rcl_interfaces::msg::Log;
using ::testing::ElementsAre;

std::unique_ptr<bus::Participant> join(const std::string& name) {
  return bus::Participant::create({.domain = test::test_domain(), .node_name = name, .loopback_only = true});
}

/// What stands on /rosout, for a reader that comes late.
class Lines {
 public:
  /// @return "LEVEL NAME TEXT" of each, once this one has come; after 10 s without it.
  std::vector<std::string> until(const std::string& line) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::seconds(10),
                      [&] { return !lines_.empty() && lines_.back() == line; });
    return lines_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> lines_;
  std::unique_ptr<bus::Participant> bus_ = join("reader");
  bus::Subscription subscription_ = bus_->subscribe<Log>(
      "/rosout", {.reliable = true, .transient_local = true, .depth = 1000}, [this](const auto& log) {
        const std::lock_guard lock(mutex_);
        lines_.push_back(fmt::format("{} {} {}", log->level(), log->name(), log->msg()));
        EXPECT_GT(log->stamp().sec(), 1'600'000'000);
        changed_.notify_all();
      });
};

TEST(Rosout, SaysWhatIsLoggedAlsoToWhoComesLate) {
  const auto bus = join("probe");
  const auto rosout = std::make_shared<Rosout>(*bus, "robot1.probe");
  spdlog::logger logger("probe", rosout);
  logger.debug("not logged");
  logger.info("begins");
  logger.warn("the camera is {}", "silent");
  logger.error("no map");
  logger.critical("ended");
  EXPECT_THAT(Lines().until("50 robot1.probe ended"),
              ElementsAre("20 robot1.probe begins", "30 robot1.probe the camera is silent",
                          "40 robot1.probe no map", "50 robot1.probe ended"));
}

TEST(Rosout, KeepsNobodyWaitingAndTheNewestLines) {
  const auto bus = join("probe");
  const auto rosout = std::make_shared<Rosout>(*bus, "probe");
  spdlog::logger logger("probe", rosout);
  for (int i = 0; i < 20'000; ++i) logger.warn("{}", i);
  logger.error("last");
  const auto told = Lines().until("40 probe last");
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told.back(), "40 probe last");
  EXPECT_LE(told.size(), 1000U) << "what a late reader gets";
}

}  // namespace
}  // namespace rds::service
