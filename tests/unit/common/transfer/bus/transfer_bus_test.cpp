// SPDX-License-Identifier: Apache-2.0
// Server and client over a real bus, in one process that pretends to be two machines.
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <future>
#include <map>
#include <mutex>
#include <optional>
#include <ranges>
#include <stdexcept>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/service/presence.hpp"
#include "common/transfer/bus/item_client.hpp"
#include "common/transfer/bus/item_server.hpp"
#include "tests/unit/common/bus/bus_test_support.hpp"
#include "tests/unit/common/transfer/bus/node.hpp"

namespace rds::transfer {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;

constexpr std::uint64_t kRobot = 1;
constexpr std::uint64_t kServerRoom = 2;
constexpr std::uint64_t kEpoch = 77;
constexpr ItemServer::Room kRoom{.memory_bytes = 2'000'000, .file_bytes = 64'000'000};
const std::string kImages = "rds/keyframe/images";
const std::string kMapper = kImages + "/mapper";

ItemServer::Bytes item_of(std::uint64_t number) {
  ItemServer::Bytes item(20'000 + 1000 * (number % 100));
  for (std::size_t i = 0; i < item.size(); ++i) item[i] = static_cast<std::uint8_t>(i * 31 + number);
  return item;
}

class TransferBus : public testing::TestWithParam<bus::Vendor> {
 protected:
  std::unique_ptr<ItemClient> make_client(std::uint64_t host) {
    return std::make_unique<ItemClient>(
        there_.context, topics::kMapper, kKeyframes, Stream::kKeyframeImages, Order::kNewest,
        ItemClient::Callbacks{
            .item = [this](std::uint64_t epoch, Item item) { take(epoch, std::move(item)); },
            .where = [this](ItemClient::Where where) { say(where); },
            .has_room = [this] { return has_room_.load(); }},
        host);
  }
  void take(std::uint64_t epoch, Item item) {
    const std::lock_guard lock(mutex_);
    EXPECT_EQ(epoch, kEpoch);
    EXPECT_EQ(item.bytes, item_of(item.number));
    arrived_[item.number]++;
    changed_.notify_all();
  }
  void say(ItemClient::Where where) {
    const std::lock_guard lock(mutex_);
    where_ = where;
    changed_.notify_all();
  }
  template <class Condition>
  bool wait_for(Condition condition, std::chrono::seconds limit = 30s) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, limit, condition);
  }
  void share(ItemServer& server, std::uint64_t number) {
    server.share(kEpoch, Stream::kKeyframeImages, number, [this, number] {
      made(number);
      return item_of(number);
    });
  }
  void made(std::uint64_t number) {
    const std::lock_guard lock(mutex_);
    made_ = number;
    changed_.notify_all();
  }
  /// No faster than they are made: what finds no room to wait for it is lost.
  void share_each(ItemServer& server, std::uint64_t first, std::uint64_t end) {
    for (std::uint64_t number = first; number < end; ++number) {
      share(server, number);
      ASSERT_TRUE(wait_for([&] { return made_ == number; })) << number;
    }
  }
  bool all_arrive(std::uint64_t first, std::uint64_t end) {
    const auto is_here = [&](std::uint64_t number) { return arrived_.contains(number); };
    return wait_for([&] { return std::ranges::all_of(std::views::iota(first, end), is_here); });
  }

  Node here_{GetParam(), "tracker"};
  Node there_{GetParam(), "mapper"};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::uint64_t, int> arrived_;
  std::optional<std::uint64_t> made_;
  std::atomic<bool> has_room_ = true;
  ItemClient::Where where_ = ItemClient::Where::kUnknown;
};

TEST_P(TransferBus, EveryItemComesOnce) {
  ItemServer server(here_.context, topics::kTracker, kKeyframes, kRoom, kRobot);
  const auto client = make_client(kServerRoom);
  ASSERT_TRUE(wait_for([&] { return where_ == ItemClient::Where::kElsewhere; }));
  share_each(server, 0, 30);
  EXPECT_TRUE(all_arrive(0, 30)) << arrived_.size();
  const std::lock_guard lock(mutex_);
  for (const auto& [id, times] : arrived_) EXPECT_EQ(times, 1) << id;
}

TEST_P(TransferBus, WhoComesLaterHasEverythingThatWasSharedBefore) {
  ItemServer server(here_.context, topics::kTracker, kKeyframes, kRoom, kRobot);
  share_each(server, 0, 100);
  const auto client = make_client(kServerRoom);
  EXPECT_TRUE(all_arrive(0, 100)) << "two of seven megabytes are in memory, the others in the file: "
                                  << arrived_.size();
  EXPECT_EQ(here_.figure(kImages + "/items shared"), 100U);
  EXPECT_TRUE(bus::eventually([&] { return here_.figure(kMapper + "/items arrived") == 100; }));
  EXPECT_EQ(here_.figure(kMapper + "/items lacking"), 0U);
  EXPECT_EQ(here_.figure(kMapper + "/items given up"), 0U);
  EXPECT_GE(here_.figure(kMapper + "/chunks sent"), 100U * 20'000 / kChunkBytes);
  EXPECT_GT(here_.figure(kMapper + "/round trip us"), 0U);
  EXPECT_GT(here_.figure(kMapper + "/link kbit_s"), 0U);
  EXPECT_EQ(here_.figure(kImages + "/detector/chunks sent"), 0U) << "nobody is there";
}

TEST_P(TransferBus, WhatIsNotKeptIsCountedAtBothEnds) {
  ItemServer server(here_.context, topics::kTracker, kKeyframes,
                    {.memory_bytes = 300'000, .file_bytes = 1'000'000}, kRobot);
  share_each(server, 0, 60);
  const auto client = make_client(kServerRoom);
  EXPECT_TRUE(all_arrive(50, 60));
  EXPECT_TRUE(bus::eventually([&] {
    return here_.figure(kMapper + "/items arrived") + here_.figure(kMapper + "/items given up") == 60;
  }));
  const std::uint64_t lost = here_.figure(kImages + "/items lost");
  EXPECT_EQ(lost, here_.figure(kMapper + "/items given up"));
  EXPECT_EQ(lost, 60 - arrived_.size());
  EXPECT_GT(lost, 30U) << "1.3 of 3 megabytes have room";
  const auto warnings = here_.diagnostics.warnings();
  ASSERT_TRUE(warnings.contains("rds/transfer/mapper given up"));
  EXPECT_EQ(warnings.at("rds/transfer/mapper given up"),
            fmt::format("rds/transfer/mapper lacks {} items that cannot be had any more", lost));
  EXPECT_EQ(there_.figure("transfer items given up"), lost);
  const auto warnings_there = there_.diagnostics.warnings();
  ASSERT_TRUE(warnings_there.contains("transfer given up"));
  EXPECT_EQ(warnings_there.at("transfer given up"),
            fmt::format("{} items of rds-tracker cannot be had any more", lost));
}

TEST_P(TransferBus, WhatCannotBeMadeInTimeIsCountedAtBothEnds) {
  std::promise<void> go_on;
  ItemServer server(here_.context, topics::kTracker, kKeyframes, kRoom, kRobot);
  server.share(kEpoch, Stream::kKeyframeImages, 0, [&go_on] {
    go_on.get_future().wait();
    return item_of(0);
  });
  for (std::uint64_t number = 1; number < 60; ++number) share(server, number);
  server.share(kEpoch, Stream::kKeyframeImages, 60, [] { return item_of(60); });
  go_on.set_value();
  ASSERT_TRUE(bus::eventually([&] { return here_.figure(kImages + "/items shared") == 61; }));
  server.share(kEpoch, Stream::kKeyframeImages, 61,
               []() -> ItemServer::Bytes { throw std::runtime_error("no keyframe"); });
  share_each(server, 62, 63);
  const auto client = make_client(kServerRoom);
  EXPECT_TRUE(all_arrive(0, 32));
  EXPECT_TRUE(all_arrive(62, 63));
  EXPECT_TRUE(bus::eventually([&] {
    return here_.figure(kMapper + "/items arrived") + here_.figure(kMapper + "/items given up") == 63;
  }));
  EXPECT_GE(here_.figure(kMapper + "/items given up"), 28U);
  EXPECT_EQ(here_.figure(kMapper + "/items given up"), here_.figure(kImages + "/items lost"));
}

TEST_P(TransferBus, ARestartedServerIsFollowed) {
  const auto client = make_client(kServerRoom);
  for (const std::uint64_t from : {0U, 1000U}) {
    Node node(GetParam(), "tracker" + std::to_string(from));  // another instance each time
    ItemServer server(node.context, topics::kTracker, kKeyframes, kRoom, kRobot);
    server.begin(kEpoch);
    share_each(server, from, from + 5);
    EXPECT_TRUE(all_arrive(from, from + 5)) << from;
  }
}

TEST_P(TransferBus, OnTheLoopbackInterfaceNothingIsMade) {
  here_.context.participant.loopback_only = true;
  ItemServer server(here_.context, topics::kTracker, kKeyframes, kRoom, kRobot);
  const auto client = make_client(kRobot);
  ASSERT_TRUE(wait_for([&] { return where_ == ItemClient::Where::kHere; }));
  for (std::uint64_t number = 0; number < 20; ++number) share(server, number);
  std::this_thread::sleep_for(500ms);
  EXPECT_EQ(made_, std::nullopt);
}

/// What waits for room is a gap as any other.
TEST_P(TransferBus, AGapIsAWarningAtBothEndsWhileItLasts) {
  service::Presence tracker(here_.context, {});
  service::Presence mapper(there_.context, {});
  tracker.set_active(true);
  mapper.set_active(true);
  ItemServer server(here_.context, topics::kTracker, kKeyframes, kRoom, kRobot);
  const auto client = make_client(kServerRoom);
  share_each(server, 0, 3);
  ASSERT_TRUE(all_arrive(0, 3)) << arrived_.size();
  has_room_ = false;
  share_each(server, 3, 6);
  const auto warning_of = [](const Node& node) {
    const auto warnings = node.diagnostics.warnings();
    return warnings.empty() ? std::string() : warnings.begin()->second;
  };
  const auto both = [&](bool warn) {
    return bus::eventually(
        [&] { return warning_of(here_).empty() != warn && warning_of(there_).empty() != warn; });
  };
  ASSERT_TRUE(both(true)) << warning_of(here_) << "; " << warning_of(there_);
  EXPECT_THAT(warning_of(there_), AllOf(HasSubstr(" items of rds-tracker on "), HasSubstr("in time")));
  EXPECT_THAT(warning_of(here_), AllOf(HasSubstr("rds-mapper on "), HasSubstr(" is behind: ")));
  has_room_ = true;
  EXPECT_TRUE(both(false)) << warning_of(here_) << "; " << warning_of(there_);
}

INSTANTIATE_TEST_SUITE_P(Both, TransferBus, testing::ValuesIn(bus::kAllVendors),
                         [](const auto& vendor) { return bus::name_of(vendor.param); });

}  // namespace
}  // namespace rds::transfer
