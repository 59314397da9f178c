// SPDX-License-Identifier: Apache-2.0
// Server and client over a real bus, in one process that pretends to be two machines.
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <ranges>
#include <thread>

#include <gmock/gmock.h>

#include "common/service/presence.hpp"
#include "common/transfer/bus/item_client.hpp"
#include "common/transfer/bus/item_server.hpp"
#include "tests/support/test_domain.hpp"
#include "tests/unit/common/bus/bus_test_support.hpp"

namespace rds::transfer {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;

constexpr std::uint64_t kRobot = 1;
constexpr std::uint64_t kServerRoom = 2;
constexpr std::uint64_t kEpoch = 77;
constexpr std::size_t kMemory = std::size_t{16} << 20U;

ItemServer::Bytes item_of(std::uint64_t number) {
  ItemServer::Bytes item(100'000 + 1000 * (number % 1000));
  for (std::size_t i = 0; i < item.size(); ++i) item[i] = static_cast<std::uint8_t>(i * 31 + number);
  return item;
}

/// A process on the bus.
struct Node {
  Node(bus::Vendor vendor, const std::string& name)
      : bus(bus::Participant::create(
            {.vendor = vendor, .domain = test::test_domain(), .node_name = name, .loopback_only = true})),
        context{"rds-" + name, *bus, diagnostics} {}
  std::unique_ptr<bus::Participant> bus;
  service::Diagnostics diagnostics;
  service::ServiceContext context;
};

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
  /// Until readers are known nothing is kept.
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
  /// As long as it takes for the first one to arrive. @return the next number
  std::uint64_t share_until_readers_are_known(ItemServer& server) {
    std::uint64_t number = 0;
    for (; !wait_for([&] { return !arrived_.empty(); }, 0s) && number < 1000; ++number) {
      share(server, number);
      std::this_thread::sleep_for(50ms);
    }
    return number;
  }
  /// No faster than they are made: of what waits the server forgets the oldest.
  void share_each(ItemServer& server, std::uint64_t first, std::uint64_t end) {
    for (std::uint64_t number = first; number < end; ++number) {
      share(server, number);
      ASSERT_TRUE(wait_for([&] { return made_ == number; })) << number;
    }
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
  ItemServer server(here_.context, topics::kTracker, kKeyframes, kMemory, kRobot);
  const auto client = make_client(kServerRoom);
  ASSERT_TRUE(wait_for([&] { return where_ == ItemClient::Where::kElsewhere; }));
  const std::uint64_t first = share_until_readers_are_known(server);
  share_each(server, first, first + 30);
  const auto is_here = [&](std::uint64_t number) { return arrived_.contains(number); };
  EXPECT_TRUE(wait_for([&] { return std::ranges::all_of(std::views::iota(first, first + 30), is_here); }))
      << arrived_.size();
  const std::lock_guard lock(mutex_);
  for (const auto& [id, times] : arrived_) EXPECT_EQ(times, 1) << id;
}

TEST_P(TransferBus, WhoComesLaterHasEverythingThatIsKept) {
  ItemServer server(here_.context, topics::kTracker, kKeyframes, 2'000'000, kRobot);
  {
    const auto first = make_client(kServerRoom);
    share_until_readers_are_known(server);
  }
  arrived_.clear();
  share_each(server, 1100, 1120);
  const auto later = make_client(kServerRoom);
  const auto is_here = [&](std::uint64_t number) { return arrived_.contains(number); };
  EXPECT_TRUE(wait_for([&] { return std::ranges::all_of(std::views::iota(1100U, 1120U), is_here); }))
      << "nine of 218 kB are in the two megabytes of memory, the others in the file: " << arrived_.size();
}

TEST_P(TransferBus, ARestartedServerIsFollowed) {
  const auto client = make_client(kServerRoom);
  for (const std::uint64_t from : {0U, 1000U}) {
    Node node(GetParam(), "tracker" + std::to_string(from));  // another instance each time
    ItemServer server(node.context, topics::kTracker, kKeyframes, kMemory, kRobot);
    server.begin(kEpoch);
    for (std::uint64_t number = from; number < from + 200; ++number) {
      if (wait_for([&] { return !arrived_.empty() && arrived_.rbegin()->first >= from; }, 0s)) break;
      share(server, number);
      std::this_thread::sleep_for(50ms);
    }
    EXPECT_TRUE(wait_for([&] { return !arrived_.empty() && arrived_.rbegin()->first >= from; }, 0s)) << from;
  }
}

TEST_P(TransferBus, OnOneMachineNothingIsMade) {
  ItemServer server(here_.context, topics::kTracker, kKeyframes, kMemory, kRobot);
  const auto client = make_client(kRobot);
  ASSERT_TRUE(wait_for([&] { return where_ == ItemClient::Where::kHere; }));
  std::atomic<bool> made = false;
  for (std::uint64_t number = 0; number < 20; ++number) {
    server.share(kEpoch, Stream::kKeyframeImages, number, [&] {
      made = true;
      return item_of(0);
    });
    std::this_thread::sleep_for(50ms);
  }
  EXPECT_FALSE(made);
}

/// What waits for room is a gap as any other.
TEST_P(TransferBus, AGapIsAWarningAtBothEndsWhileItLasts) {
  service::Presence tracker(here_.context, {});
  service::Presence mapper(there_.context, {});
  tracker.set_active(true);
  mapper.set_active(true);
  ItemServer server(here_.context, topics::kTracker, kKeyframes, kMemory, kRobot);
  const auto client = make_client(kServerRoom);
  const std::uint64_t next = share_until_readers_are_known(server);
  has_room_ = false;
  share_each(server, next, next + 3);
  const auto warning_of = [](const Node& node) {
    const auto warnings = node.diagnostics.warnings();
    return warnings.empty() ? std::string() : warnings.begin()->second;
  };
  const auto both = [&](bool warn) {
    return bus::eventually(
        [&] { return warning_of(here_).empty() != warn && warning_of(there_).empty() != warn; });
  };
  ASSERT_TRUE(both(true)) << warning_of(here_) << "; " << warning_of(there_);
  EXPECT_THAT(warning_of(there_),
              AllOf(HasSubstr(" items of rds-tracker on "), HasSubstr("in time")));
  EXPECT_THAT(warning_of(here_), AllOf(HasSubstr("rds-mapper on "), HasSubstr(" is behind: ")));
  has_room_ = true;
  EXPECT_TRUE(both(false)) << warning_of(here_) << "; " << warning_of(there_);
}

INSTANTIATE_TEST_SUITE_P(Both, TransferBus, testing::ValuesIn(bus::kAllVendors),
                         [](const auto& vendor) { return bus::name_of(vendor.param); });

}  // namespace
}  // namespace rds::transfer
