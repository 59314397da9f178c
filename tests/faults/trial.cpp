// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/trial.hpp"

#include <algorithm>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "tests/faults/true_stamps.hpp"
#include "tests/integration/run_support.hpp"
#include "tools/rds/play/decode_ahead.hpp"
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
constexpr auto kWorkerLimit = 20s;  // a worker answers between two steps, of which one may take seconds
constexpr auto kAcknowledgeLimit = 10s;
constexpr auto kFinishLimit = 120s;
constexpr auto kStopLimit = 8s;
const std::string kMapName = "map";

}  // namespace

Trial::Trial(const fs::path& recording, const Row& row, const Timing& timing, const fs::path& out,
             int patience)
    : row_(row),
      timing_(timing),
      out_(out),
      patience_(patience),
      dataset_(image::TumDataset::open(recording).value()),
      options_(options(recording)),
      bus_(bus::Participant::create(
          {.vendor = row.vendor, .domain = domain_.domain(), .node_name = "trial", .loopback_only = true})),
      recorder_(*bus_),
      commander_(*bus_),
      camera_(*bus_, row, timing),
      disk_(row, out.parent_path()),
      commands_(commands()),
      fleet_(commands_) {}

run::RunOptions Trial::options(const fs::path& recording) const {
  run::RunOptions options;
  options.dataset = recording;
  options.out = out_;
  options.default_vendor = row_.vendor;
  return options;
}

std::vector<run::ServiceCommand> Trial::commands() {
  auto commands = run::service_commands(options_, domain_.domain(), out_);
  for (auto& command : commands) command.command.front() = RDS_BIN_DIR "/" + command.name;
  return commands;
}

Trial::Report Trial::run() {
  wait_until_connected();
  play();
  expect_living_workers();
  drain();
  fleet_.stop(patient(kStopLimit));
  for (const auto& [service, usage] : fleet_.usage()) report_.ends[service] = usage.failures;
  write_results();
  return report_;
}

void Trial::wait_until_connected() {
  const auto deadline = Clock::now() + patient(kConnectLimit);
  std::set<std::string> running = fleet_.names();
  running.insert(run::kPlayer);
  std::vector<std::string> missing{"nobody answers"};
  while (Clock::now() < deadline) {
    const auto statuses = commander_.ask_status(commands_.size(), {}, patient(kStatusLimit));
    missing = run::missing_links(running, run::endpoints_of(*bus_, statuses));
    std::erase_if(missing,
                  [](const std::string& link) { return link.find("rds/features") != std::string::npos; });
    if (missing.empty()) return;
  }
  throw std::runtime_error(fmt::format("the services did not come together: {}", fmt::join(missing, "; ")));
}

void Trial::play() {
  const auto& frames = dataset_.frames();
  const auto command = std::ranges::find(commands_, row_.service, &run::ServiceCommand::name);
  ProcessFault fault(row_, timing_, command == commands_.end() ? run::ServiceCommand{} : *command, commander_,
                     disk_);
  play::DecodeAhead decoder(dataset_, 0, frames.size(), false);
  const auto started = Clock::now();
  while (auto decoded = decoder.next({})) {
    const double at_s = static_cast<double>(decoded->frame.value().stamp_ns - frames.front().stamp_ns) * 1e-9;
    if (at_s > timing_.total_s) break;
    std::this_thread::sleep_until(started + std::chrono::duration_cast<Clock::duration>(
                                                std::chrono::duration<double>(at_s / timing_.rate)));
    fault.act(at_s);
    camera_.show(*decoded->frame, frames[decoded->index].depth_stamp_ns, at_s);
    ++report_.frames;
    fleet_.watch();
  }
  if (const std::string verdict = fault.verdict(); !verdict.empty()) report_.faults.push_back(verdict);
}

/// Every worker answers a command, be it that it does not know it.
void Trial::expect_living_workers() {
  for (const std::string& service : fleet_.names())
    if (!commander_.ask(service, "resume", "", {}, patient(kWorkerLimit)))
      report_.faults.push_back(service + " hangs");
}

/// As `rds run` ends a run.
void Trial::drain() {
  recorder_.wait_acknowledged(camera_.last_stamp_ns(), {}, patient(kAcknowledgeLimit));
  const std::string final_poses = ask(run::kTracker, "finish", "");
  recorder_.wait_poses(number_in(final_poses, "poses_revision"), {}, patient(kAcknowledgeLimit));
  report_.keyframes = number_in(final_poses, "keyframes");
  report_.integrated = number_in(ask(run::kMapper, "finish", final_poses), "keyframes");
  save_map();
}

void Trial::save_map() {
  nlohmann::json order{{"name", kMapName}, {"id", "trial"}, {"parts", nlohmann::json::array()}};
  const std::vector<std::string> services{run::kTracker, run::kMapper, run::kLoopCloser};
  for (const std::string& service : services) order["parts"].push_back(run::part_of(service));
  for (const std::string& service : services) ask(service, "save", order.dump());
  const fs::path saved = out_ / run::kMapsFolder / kMapName;
  if (!fs::exists(saved)) return report_.faults.push_back("the map was not saved");
  for (const auto& file : fs::directory_iterator(saved))
    fs::rename(file.path(), out_ / file.path().filename());
}

std::string Trial::ask(const std::string& service, const std::string& verb, const std::string& argument) {
  fleet_.watch();
  const auto reply = commander_.ask(service, verb, argument, {}, patient(kFinishLimit));
  if (reply && reply->success) return reply->message;
  report_.faults.push_back(fmt::format("{} {}: {}", service, verb, reply ? reply->message : "no answer"));
  return {};
}

void Trial::write_results() {
  run::Recording recording = with_true_stamps(recorder_.recording(), camera_.true_stamps());
  report_.localized = static_cast<std::size_t>(
      std::ranges::count_if(recording.frames, [](const auto& frame) { return frame.second.has_pose; }));
  run::write_run_files(recording, out_, false);
}

}  // namespace rds::test
