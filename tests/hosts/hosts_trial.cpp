// SPDX-License-Identifier: Apache-2.0
#include "tests/hosts/hosts_trial.hpp"

#include <algorithm>
#include <csignal>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/bus/peer_addresses.hpp"
#include "common/topics/topics.hpp"
#include "tests/integration/run_support.hpp"
#include "tools/rds/run/results/run_files.hpp"
#include "tools/rds/run/services/service_commands.hpp"
#include "tools/rds/topology/topology.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

constexpr auto kConnectLimit = 40s;
constexpr auto kStatusLimit = 500ms;
constexpr auto kLastStatusLimit = 3s;
constexpr auto kAcknowledgeLimit = 10s;
constexpr auto kFinishLimit = 120s;
constexpr auto kStopLimit = 8s;
constexpr auto kJoinTime = 5s;
const std::string kMapName = "map";
const std::string kA = "A";
const std::string kIdle = "D";
constexpr const char* kZenohSettings = "ZENOH_CONFIG";

/// Which service runs on which host when they are on three.
const std::map<std::string, std::string>& placement() {
  static const std::map<std::string, std::string> kPlacement{{run::kTracker, "A"},
                                                             {run::kDetector, "B"},
                                                             {run::kTransformer, "B"},
                                                             {run::kMapper, "C"},
                                                             {run::kLoopCloser, "C"}};
  return kPlacement;
}

std::vector<std::string> hosts_of(const Row& row) {
  if (row.on_one_machine) return {kA};
  std::vector<std::string> hosts{kA, "B", "C"};
  if (row.has_bystanders) hosts.push_back(kIdle);
  if (row.way != Way::kDirect) hosts.emplace_back(kRouterHost);
  return hosts;
}

/// Held to the cores that the row allows it.
std::vector<std::string> held(std::vector<std::string> command, Cores cores, const std::string& host) {
  if (cores == Cores::kAny) return command;
  const bool is_second = cores == Cores::kOfEachHost && host != kA;
  command.insert(command.begin(), {"/usr/bin/taskset", "--cpu-list", is_second ? "1" : "0"});
  return command;
}

/// By the host's clock.
std::vector<std::string> shifted(std::vector<std::string> command, int shift_s, const std::string& host) {
  if (shift_s == 0 || host == kA) return command;
  command.insert(command.begin(), {"/usr/bin/env", "LD_PRELOAD=" RDS_SHIFTED_CLOCK,
                                   fmt::format("RDS_CLOCK_SHIFT_S={}", host == "B" ? shift_s : -shift_s)});
  return command;
}

/// Topics that nobody reads, or whose readers take a transfer instead when they are on another machine.
bool may_be_missing(const std::string& link, bool on_one_machine) {
  const auto is_of = [&](const std::string& topic) {
    return link.find(" " + topic + ":") != std::string::npos;
  };
  return is_of(topics::kFeatures.name) ||
         (!on_one_machine && (is_of(topics::kKeyframeImages.name) || is_of(topics::kKeyframeFeatures.name)));
}

}  // namespace

HostsTrial::HostsTrial(const Row& row, const fs::path& recording, fs::path out)
    : row_(row),
      out_(std::move(out)),
      dataset_(image::TumDataset::open(recording).value()),
      poses_(row.poses_are_given() ? recording / "groundtruth.txt" : fs::path()),
      network_(hosts_of(row), row.link, row.has_multicast),
      routers_(network_, row.way, out_),
      here_(network_, kA),
      core_(row.cores == Cores::kAny ? -1 : 1),
      bus_(join()),
      recorder_(*bus_),
      commander_(*bus_),
      arrivals_(*bus_),
      camera_(*bus_, dataset_, {}),
      fleet_(commands(false)) {}

/// As the other programs on A.
std::unique_ptr<bus::Participant> HostsTrial::join() const {
  const std::string settings = routers_.client_settings(kA);
  if (!settings.empty()) setenv(kZenohSettings, settings.c_str(), 1);
  auto bus = bus::Participant::create({.vendor = row_.vendor,
                                       .domain = domain_.domain(),
                                       .node_name = "hosts_trial",
                                       .peers = bus::peer_addresses(peers_of(kA))});
  unsetenv(kZenohSettings);
  return bus;
}

bool HostsTrial::is_late(const std::string& host) const {
  return row_.absence && row_.absence->kind == Absence::Kind::kLate && row_.absence->host == host;
}

/// On each host as `rds run` would start them there. @param late  on the host that comes late, or on the
/// others
std::vector<run::ServiceCommand> HostsTrial::commands(bool late) const {
  std::vector<run::ServiceCommand> all;
  for (const std::string host : {"A", "B", "C"}) {
    if (is_late(host) != late) continue;
    run::RunOptions options;
    options.default_vendor = row_.vendor;
    options.network = true;
    options.poses = poses_;
    if (!row_.has_multicast) options.here = {run::services_of(options), peers_of(host)};
    for (auto& command : run::service_commands(options, domain_.domain(), folder_of(host))) {
      if (placement().at(command.name) != host) continue;
      if (row_.cores == Cores::kOneForTracker && command.name != run::kTracker) continue;
      command.command.front() = RDS_BIN_DIR "/" + command.name;
      command.command = shifted(held(command.command, row_.cores, host), row_.clock_shift_s, host);
      if (const std::string settings = routers_.client_settings(host); !settings.empty())
        command.command.insert(command.command.begin(), {"/usr/bin/env", kZenohSettings + ("=" + settings)});
      if (!row_.on_one_machine) command.command = network_.on(host, command.command);
      all.push_back(std::move(command));
    }
  }
  return all;
}

/// Addresses that a program on this host is told, with commas.
std::string HostsTrial::peers_of(const std::string& host) const {
  std::string peers;
  if (row_.has_multicast) return peers;
  if (row_.way != Way::kDirect) return network_.address(kRouterHost);
  for (const std::string& other : hosts_of(row_))
    if (other != host) peers += (peers.empty() ? "" : ",") + network_.address(other);
  return peers;
}

HostFigures HostsTrial::run() {
  wait_until_connected();
  if (row_.has_bystanders) add_second_reader();
  const std::uint64_t sent_before = bytes_sent();
  const std::uint64_t idle_before = idle_bytes();
  const auto started = Clock::now();
  play();
  const std::chrono::duration<double> played = Clock::now() - started;
  figures_.idle_kbit_s = static_cast<double>(idle_bytes() - idle_before) * 8e-3 / played.count();
  const auto sent = static_cast<double>(bytes_sent() - sent_before);
  drain();
  figures_.keyframes = arrivals_.keyframes();
  const auto times_ms = arrivals_.answer_times_ms();
  figures_.answered = times_ms.size();
  figures_.p50_ms = quantile(times_ms, 0.5);
  figures_.p95_ms = quantile(times_ms, 0.95);
  figures_.link_bytes = sent / static_cast<double>(std::max<std::size_t>(1, figures_.keyframes));
  note_statuses();
  fleet_.stop(kStopLimit);
  const run::Recording recording = recorder_.recording();
  figures_.localized = static_cast<std::size_t>(
      std::ranges::count_if(recording.frames, [](const auto& frame) { return frame.second.has_pose; }));
  std::vector<double> totals_ms;
  for (const auto& [stamp_ns, frame] : recording.frames) totals_ms.push_back(frame.total_ms);
  std::ranges::sort(totals_ms);
  figures_.p99_total_ms = quantile(totals_ms, 0.99);
  run::write_run_files(recording, out_, false);
  return figures_;
}

/// Of the camera; all that its coming makes the others say is over when this returns.
void HostsTrial::add_second_reader() {
  second_reader_ = std::make_unique<Process>(
      network_.on(kA, {RDS_BIN_DIR "/rds", "topic", "hz", topics::kColor.name, "--bus",
                       bus::name_of(row_.vendor), "--domain", std::to_string(domain_.domain())}));
  std::this_thread::sleep_for(kJoinTime);
}

/// That have reached the host where nothing runs.
std::uint64_t HostsTrial::idle_bytes() const {
  if (!row_.has_bystanders) return 0;
  const OnHost there(network_, kIdle);
  return bytes_received();
}

void HostsTrial::wait_until_connected() {
  const auto deadline = Clock::now() + kConnectLimit;
  std::set<std::string> running = fleet_.names();
  running.insert(run::kPlayer);
  std::vector<std::string> missing{"nobody answers"};
  while (Clock::now() < deadline) {
    fleet_.watch();
    const auto statuses = commander_.ask_status(fleet_.names().size(), {}, kStatusLimit);
    missing = run::missing_links(running, run::endpoints_of(*bus_, statuses));
    std::erase_if(missing, [&](const auto& link) { return may_be_missing(link, row_.on_one_machine); });
    if (missing.empty()) return;
  }
  throw std::runtime_error(fmt::format("the services did not come together: {}", fmt::join(missing, "; ")));
}

void HostsTrial::play() {
  const std::int64_t first_ns = dataset_.frames().front().stamp_ns;
  const auto report = camera_.run({}, [&](const image::RgbdFrame& frame, std::size_t) {
    const double at_s = static_cast<double>(frame.stamp_ns - first_ns) * 1e-9;
    last_stamp_ns_ = frame.stamp_ns;
    be_absent(at_s);
    fleet_.watch();
    return row_.length_s == 0 || at_s < row_.length_s;
  });
  figures_.frames = report.played;
  figures_.longest_gap_s = arrivals_.longest_gap_s();
}

void HostsTrial::be_absent(double at_s) {
  if (!row_.absence) return;
  const Absence& absence = *row_.absence;
  if (phase_ == Phase::kBefore && at_s >= absence.from_s) {
    phase_ = Phase::kDuring;
    if (absence.kind == Absence::Kind::kUnplugged) return network_.unplug(absence.host);
    if (absence.kind == Absence::Kind::kNoRouter) return routers_.kill();
    if (absence.kind == Absence::Kind::kReplaced) return replace(absence.host);
  }
  if (phase_ != Phase::kDuring || at_s < absence.from_s + absence.for_s) return;
  phase_ = Phase::kAfter;
  if (absence.kind == Absence::Kind::kUnplugged) network_.plug(absence.host);
  if (absence.kind == Absence::Kind::kNoRouter) routers_.start();
  if (absence.kind == Absence::Kind::kLate)
    for (run::ServiceCommand& command : commands(true)) fleet_.start(std::move(command));
}

/// Whoever looks after the services starts them again.
void HostsTrial::replace(const std::string& host) {
  for (const auto& [service, its_host] : placement())
    if (its_host == host)
      for (const pid_t pid : children(getpid(), service)) kill(pid, SIGKILL);
  fs::remove_all(folder_of(host) / run::kMapsFolder);
}

/// As `rds run` ends a run.
void HostsTrial::drain() {
  recorder_.wait_acknowledged(last_stamp_ns_, {}, kAcknowledgeLimit);
  const std::string poses = ask(run::kTracker, "finish", "");
  recorder_.wait_poses(number_in(poses, "poses_revision"), {}, kAcknowledgeLimit);
  if (!fleet_.names().contains(run::kMapper)) return;
  const std::uint64_t mapped = number_in(ask(run::kMapper, "finish", poses), "keyframes");
  const std::uint64_t made = number_in(poses, "keyframes");
  figures_.missing = made > mapped ? made - mapped : 0;
  save_map();
}

/// The mapper's part: it lies on the mapper's machine.
void HostsTrial::save_map() {
  ask(run::kMapper, "save", kMapName);
  const fs::path saved = folder_of(placement().at(run::kMapper)) / run::kMapsFolder / kMapName / "map.ot";
  if (!fs::exists(saved)) return figures_.faults.push_back("the map was not saved");
  fs::copy_file(saved, out_ / "map.ot");
}

std::string HostsTrial::ask(const std::string& service, const std::string& verb,
                            const std::string& argument) {
  fleet_.watch();
  const auto reply = commander_.ask(service, verb, argument, {}, kFinishLimit);
  if (!reply || !reply->success)
    figures_.faults.push_back(fmt::format("{} {}: {}", service, verb, reply ? reply->message : "no answer"));
  return reply ? reply->message : "";
}

void HostsTrial::note_statuses() {
  const auto statuses = commander_.ask_status(fleet_.names().size(), {}, kLastStatusLimit);
  for (const auto& [service, text] : statuses) write_text(out_ / (service + ".json"), text);
  add_transfer(statuses, figures_);
}

}  // namespace rds::test
