// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/transfer/bus/backlog.hpp"
#include "common/transfer/hello.hpp"
#include "common/transfer/receiver.hpp"
#include "tests/unit/common/transfer/link.hpp"

namespace rds::transfer {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kHeaderBytes = 150;
constexpr Time kRepair = 50ms;
constexpr std::size_t kLanes = 32;

/// Keyframes of a walking robot, offered five times a second to readers behind one uplink.
class Transfer {
 public:
  Transfer(const LinkQuality& quality, int readers)
      : uplink_(events_, quality, 1), downlink_(events_, quality, 2) {
    const Way way = quality.in_order ? Way::kStream : Way::kDatagrams;
    for (int i = 0; i < readers; ++i) readers_.push_back({.receiver = Receiver(Order::kNewest, way)});
  }

  void run(int keyframes, std::size_t bytes, Time period = 200ms) {
    for (int i = 0; i < keyframes; ++i) events_.at(i * period, [this, i, bytes] { make(i, bytes); });
    const Time end = keyframes * period + 10s;
    for (Time t{}; t < end; t += 250ms) events_.at(t, [this] { look(); });
    events_.run(end);
  }
  void cut(Time from, Time to) {
    events_.at(from, [this] { uplink_.connected = downlink_.connected = false; });
    events_.at(to, [this] { uplink_.connected = downlink_.connected = true; });
  }

  [[nodiscard]] std::size_t arrived(int reader) const { return readers_[reader].delays.size(); }
  [[nodiscard]] Time delay(int reader, double quantile) const {
    std::vector<Time> delays = readers_[reader].delays;
    std::ranges::sort(delays);
    return delays.at(static_cast<std::size_t>(quantile * static_cast<double>(delays.size() - 1)));
  }
  [[nodiscard]] double repeated() const {
    double all = 0;
    double repeated = 0;
    for (const Reader& r : readers_) {
      all += static_cast<double>(r.receiver.statistics().chunks);
      repeated += static_cast<double>(r.receiver.statistics().repeated);
    }
    return repeated / all;
  }
  /// When somebody looked, four times a second, and either end knew of a reader that is behind.
  [[nodiscard]] const std::vector<Time>& behind_at_reader() const { return behind_at_reader_; }
  [[nodiscard]] const std::vector<Time>& behind_at_writer() const { return behind_at_writer_; }
  [[nodiscard]] const Receiver& receiver(int reader) const { return readers_[reader].receiver; }

 private:
  struct Reader {
    Receiver receiver;
    std::array<std::uint64_t, kLanes> sent{};   // of each lane
    std::array<std::uint64_t, kLanes> heard{};  // the newest of each
    std::vector<Time> delays{};
    std::uint64_t timer = 0;
    Hello hello{};
    std::unique_ptr<Backlog> at_reader = std::make_unique<Backlog>();
    std::unique_ptr<Backlog> at_writer = std::make_unique<Backlog>();
  };

  void make(int number, std::size_t bytes) {
    items_[number] = std::vector<std::uint8_t>(bytes, static_cast<std::uint8_t>(number));
    made_[number] = events_.now();
    for (std::size_t i = 0; i < readers_.size(); ++i) {
      auto heard = std::make_shared<bool>(false);
      send_offer(i, number, heard);
    }
  }
  /// The bus repeats an offer that was lost.
  void send_offer(std::size_t i, int number, const std::shared_ptr<bool>& heard) {
    if (*heard) return;
    uplink_.send(kHeaderBytes, [this, i, number, heard] {
      *heard = true;
      offer(i, number);
    });
    events_.at(events_.now() + kRepair, [=, this] { send_offer(i, number, heard); });
  }
  void offer(std::size_t i, int newest) {
    readers_[i].receiver.offer({0, static_cast<std::uint64_t>(newest)}, events_.now());
    ask(i);
  }
  void ask(std::size_t i) {
    Reader& reader = readers_[i];
    const Time now = events_.now();
    const std::vector<Request> due = reader.receiver.due(now);
    const std::size_t overdue = reader.receiver.overdue(now);
    reader.at_reader->set(overdue, now);
    for (const Request& request : due)
      downlink_.send(kHeaderBytes, [=, this] {
        readers_[i].at_writer->set(overdue, events_.now());
        answer(i, request);
      });
    if (reader.hello.is_due(overdue, now) && due.empty())
      downlink_.send(kHeaderBytes, [=, this] { readers_[i].at_writer->set(overdue, events_.now()); });
    const Time next = std::min(reader.receiver.next_due().value_or(now + 500ms),
                               reader.receiver.next_overdue(now).value_or(now + 500ms));
    events_.at(next, [this, i, timer = ++reader.timer] {
      if (readers_[i].timer == timer) ask(i);
    });
  }
  /// As who tells of warnings.
  void look() {
    for (const Reader& reader : readers_) {
      if (reader.at_reader->behind(events_.now())) behind_at_reader_.push_back(events_.now());
      if (reader.at_writer->behind(events_.now())) behind_at_writer_.push_back(events_.now());
    }
  }
  void answer(std::size_t i, const Request& request) {
    const auto& item = items_.at(static_cast<int>(request.number));
    for (std::uint32_t k = request.first; k < std::min(request.first + request.count, chunks_in(item.size()));
         ++k)
      send(i, chunk_of(request.number, item, k));
  }
  /// As a best-effort writer and its reader.
  void send(std::size_t i, const Chunk& chunk) {
    const std::size_t lane = chunk.index % kLanes;
    uplink_.send(kChunkBytes + kHeaderBytes, [this, i, chunk, lane, n = ++readers_[i].sent[lane]] {
      std::uint64_t& newest = readers_[i].heard[lane];
      if (n < newest) return;
      newest = n;
      take(i, chunk);
    });
  }
  void take(std::size_t i, const Chunk& chunk) {
    if (const auto item = readers_[i].receiver.take(chunk, events_.now())) {
      EXPECT_EQ(item->bytes, items_.at(static_cast<int>(item->number)));
      readers_[i].delays.push_back(events_.now() - made_.at(static_cast<int>(item->number)));
    }
    ask(i);
  }

  Events events_;
  Link uplink_;
  Link downlink_;
  std::map<int, std::vector<std::uint8_t>> items_;
  std::map<int, Time> made_;
  std::vector<Reader> readers_;
  std::vector<Time> behind_at_reader_;
  std::vector<Time> behind_at_writer_;
};

struct Case {
  std::string name;
  LinkQuality quality;
  Time p95;  // of a keyframe's way, from offer to whole
};

class TransferOnLinks : public testing::TestWithParam<Case> {};

TEST_P(TransferOnLinks, NothingIsMissingAndLittleRepeated) {
  Transfer transfer(GetParam().quality, 2);
  transfer.run(100, 120'000);
  for (const int reader : {0, 1}) {
    EXPECT_EQ(transfer.arrived(reader), 100U);
    EXPECT_LE(transfer.delay(reader, 0.95), GetParam().p95)
        << "p50 " << transfer.delay(reader, 0.5) / 1ms << " ms, p95 " << transfer.delay(reader, 0.95) / 1ms
        << " ms";
    RecordProperty("p95_ms", static_cast<int>(transfer.delay(reader, 0.95) / 1ms));
  }
  EXPECT_LE(transfer.repeated(), 0.10);
  EXPECT_TRUE(transfer.behind_at_reader().empty());
  EXPECT_TRUE(transfer.behind_at_writer().empty());
}

INSTANTIATE_TEST_SUITE_P(
    Each, TransferOnLinks,
    testing::Values(Case{"Gigabit", {}, 20ms}, Case{"Mbit100", {.mbit_per_s = 100}, 60ms},
                    Case{"Mbit40", {.mbit_per_s = 40}, 100ms}, Case{"Mbit20", {.mbit_per_s = 20}, 200ms},
                    Case{"Loss1", {.loss = 0.01}, 40ms}, Case{"Loss5", {.loss = 0.05}, 80ms},
                    Case{"Jitter", {.delay = 20ms, .jitter = 10ms}, 220ms},
                    Case{"WiFi", {.mbit_per_s = 40, .delay = 3ms, .loss = 0.01}, 200ms}),
    [](const auto& of) { return of.param.name; });

TEST(Transfer, JitterOfAStreamIsNoQueue) {
  Transfer transfer({.delay = 20ms, .jitter = 10ms, .in_order = true}, 2);
  transfer.run(150, 143'000, 120ms);
  for (const int reader : {0, 1}) {
    EXPECT_EQ(transfer.arrived(reader), 150U);
    EXPECT_LE(transfer.delay(reader, 0.95), 200ms);
  }
}

TEST(Transfer, SlowLinkCarriesFreshWholeItems) {
  Transfer transfer({.mbit_per_s = 2}, 1);  // 4.8 are made in a second, .5 of a second is needed for one
  transfer.run(50, 120'000);
  EXPECT_GE(transfer.arrived(0), 18U + 16U);  // 10 s while they are made, 10 s afterwards
  EXPECT_LE(transfer.delay(0, 0.3), 1200ms);
  EXPECT_LE(transfer.repeated(), 0.10);
}

TEST(Transfer, BothEndsKnowWithinTwoSecondsThatALinkIsFullAndWhenItIsNoMore) {
  Transfer transfer({.mbit_per_s = 2}, 1);
  transfer.run(20, 120'000);  // in 4 s, which the link carries in 10
  ASSERT_EQ(transfer.arrived(0), 20U);
  for (const auto& behind : {transfer.behind_at_reader(), transfer.behind_at_writer()}) {
    ASSERT_FALSE(behind.empty());
    EXPECT_LE(behind.front(), 200ms + 2s) << "the second keyframe is the first that has to wait";
    EXPECT_GE(behind.back(), 9s);
    EXPECT_LE(behind.back(), 11s);
  }
}

TEST(Transfer, GapIsFilledAfterwards) {
  Transfer transfer({.mbit_per_s = 100}, 1);
  transfer.cut(3s, 13s);
  transfer.run(100, 120'000);
  EXPECT_EQ(transfer.arrived(0), 100U);
  EXPECT_EQ(transfer.receiver(0).lacking(), 0U);
}

}  // namespace
}  // namespace rds::transfer
