// SPDX-License-Identifier: Apache-2.0
#include "tests/hosts/maps/map_trial.hpp"

#include <fstream>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "common/bus/peer_addresses.hpp"
#include "tests/hosts/figures.hpp"
#include "tests/integration/run_support.hpp"
#include "tools/rds/run/services/service_commands.hpp"
#include "tools/rds/topology/topology.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kConnectLimit = 40s;
constexpr auto kStatusLimit = 500ms;
constexpr auto kStopLimit = 8s;
constexpr std::size_t kServices = 5;
constexpr std::size_t kFollowers = 2;
constexpr double kReadersComeS = 6;  // of the recording
const std::string kSlow = "D";
const std::string kFast = "A";

std::string name_of(SlowReaders readers) {
  return readers == SlowReaders::kNone ? "nobody" : readers == SlowReaders::kTopics ? "topics" : "transfer";
}

/// Of all threads of a process [s].
double cpu_s(pid_t process) {
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  std::string word;
  constexpr int kUserTime = 14;  // counted from 1, then the kernel's
  double ticks = 0;
  for (int field = 1; field <= kUserTime + 1 && file >> word; ++field)
    if (field >= kUserTime) ticks += std::stod(word);
  return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

}  // namespace

std::string MapRow::label() const {
  return fmt::format("{}_{}_mbit_{}", name_of(readers), rate_mbit, bus::name_of(vendor));
}

void PrintTo(const MapRow& row, std::ostream* out) {
  *out << row.label();
}

std::string to_line(const MapRow& row, const MapFigures& f) {
  std::string line = fmt::format("{:<26}", row.label());
  for (const FollowerFigures& follower : f.followers)
    line += fmt::format(" first {:.1f} s, behind p95 {:.2f} max {:.2f} s, {} steps;", follower.first_s,
                        follower.behind_p95_s, follower.behind_max_s, follower.steps);
  return line + fmt::format(
                    " offered {:.1f} Mbit/s, mapper {:.3f} cores, delta p50 {:.1f} p95 {:.0f} ms, boxes p50 "
                    "{:.1f} p95 {:.0f} ms, gap {:.2f} s",
                    f.offered_mbit_s, f.mapper_cpu, f.near_p50_ms, f.near_p95_ms, f.boxes_p50_ms,
                    f.boxes_p95_ms, f.gap_s);
}

MapTrial::MapTrial(const MapRow& row, const std::filesystem::path& recording, std::filesystem::path out)
    : row_(row),
      out_(std::move(out)),
      dataset_(image::TumDataset::open(recording).value()),
      network_({kSlow, kFast}, {.rate_mbit = row.rate_mbit}),
      here_(network_, kFast),
      bus_(bus::Participant::create({.vendor = row.vendor,
                                     .domain = domain_.domain(),
                                     .node_name = "map_trial",
                                     .peers = bus::peer_addresses(peers_of(kFast))})),
      commander_(*bus_),
      arrivals_(*bus_),
      revisions_(*bus_),
      camera_(*bus_, dataset_, {}),
      fleet_(commands()) {}

std::vector<run::ServiceCommand> MapTrial::commands() const {
  run::RunOptions options;
  options.default_vendor = row_.vendor;
  options.network = true;
  if (const std::string peers = peers_of(kFast); !peers.empty())
    options.here = {run::services_of(options), peers};
  auto commands = run::service_commands(options, domain_.domain(), out_);
  for (auto& command : commands) command.command.front() = RDS_BIN_DIR "/" + command.name;
  return commands;
}

/// Zenoh does not go by multicast between machines, so they are told each other's addresses.
std::string MapTrial::peers_of(const std::string& host) const {
  if (row_.vendor != bus::Vendor::kZenoh) return "";
  return network_.address(host == kFast ? kSlow : kFast);
}

MapFigures MapTrial::run() {
  wait_until_connected();
  const pid_t mapper = children(getpid(), run::kMapper).at(0);
  const std::uint64_t sent_before = bytes_sent();
  const double cpu_before = cpu_s(mapper);
  const double begin_s = steady_s();
  play();
  const double end_s = steady_s();
  MapFigures figures;
  figures.offered_mbit_s = static_cast<double>(bytes_sent() - sent_before) * 8e-6 / (end_s - begin_s);
  figures.mapper_cpu = (cpu_s(mapper) - cpu_before) / (end_s - begin_s);
  for (const auto& follower : followers_)
    figures.followers.push_back(revisions_.follower(follower->standard_output(), end_s));
  const auto delays_ms = revisions_.delays_ms(arrivals_.keyframe_times());
  figures.near_p50_ms = quantile(delays_ms, 0.5);
  figures.near_p95_ms = quantile(delays_ms, 0.95);
  const auto boxes_ms = arrivals_.answer_times_ms();
  figures.boxes_p50_ms = quantile(boxes_ms, 0.5);
  figures.boxes_p95_ms = quantile(boxes_ms, 0.95);
  figures.gap_s = arrivals_.longest_gap_s();
  followers_.clear();
  fleet_.stop(kStopLimit);
  return figures;
}

void MapTrial::wait_until_connected() {
  const auto deadline = Clock::now() + kConnectLimit;
  std::vector<std::string> missing{"nobody answers"};
  while (!missing.empty()) {
    if (Clock::now() > deadline)
      throw std::runtime_error(
          fmt::format("the services did not come together: {}", fmt::join(missing, "; ")));
    fleet_.watch();
    const auto statuses = commander_.ask_status(kServices, {}, kStatusLimit);
    missing = run::missing_links(fleet_.names(), run::endpoints_of(*bus_, statuses));
  }
}

void MapTrial::play() {
  const std::int64_t first_ns = dataset_.frames().front().stamp_ns;
  camera_.run({}, [&](const image::RgbdFrame& frame, std::size_t) {
    if (static_cast<double>(frame.stamp_ns - first_ns) * 1e-9 > kReadersComeS) start_readers();
    fleet_.watch();
    return true;
  });
}

/// They give way: a machine of their own would have processors of its own.
void MapTrial::start_readers() {
  if (row_.readers == SlowReaders::kNone) return;
  const std::vector<std::string> command{"nice",
                                         "-n",
                                         "19",
                                         RDS_MAP_FOLLOWER,
                                         bus::name_of(row_.vendor),
                                         std::to_string(domain_.domain()),
                                         name_of(row_.readers),
                                         peers_of(kSlow)};
  while (followers_.size() < kFollowers)
    followers_.push_back(std::make_unique<Process>(network_.on(kSlow, command)));
}

}  // namespace rds::test
