// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/far/far_run.hpp"

#include <cstdlib>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "common/topics/endpoints.hpp"
#include "tools/rds/run/far/file_pieces.hpp"
#include "tools/rds/run/far/terms.hpp"
#include "tools/rds/run/far/usage.hpp"
#include "tools/rds/run/services/join_bus.hpp"
#include "tools/rds/run/services/service_commands.hpp"

namespace rds::run {
namespace fs = std::filesystem;
namespace {

using namespace std::chrono_literals;

constexpr auto kWatchPeriod = 200ms;
constexpr auto kSilenceLimit = 30s;
constexpr auto kStopLimit = 12s;  // less than who asked waits for it
constexpr auto kGoodByeTime = 1s;              // in which an answer is repeated that a bad link has lost
constexpr std::size_t kMaxRequests = 1000;

fs::path make_folder() {
  std::string name = (fs::temp_directory_path() / "rds-run-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": cannot be made");
  return name;
}

}  // namespace

FarRun::FarRun(RunOptions options, const hosts::HostsFile& hosts, const std::string& machine)
    : options_(std::move(options)),
      machine_(hosts.machine(machine)),
      folder_(make_folder()),
      bus_(join_bus(options_, options_.domain.value())),
      replies_(topics::advertise(*bus_, topics::kRunReply, topics::kFarRun)),
      requests_(mailbox_, kMaxRequests),
      subscription_(topics::subscribe(*bus_, topics::kRunRequest, topics::kFarRun, [this](const auto& m) {
        if (m->target() == machine_.name) requests_.push(m);
      })) {}

FarRun::~FarRun() {
  fleet_.reset();
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

int FarRun::run(const std::stop_token& stop) {
  fmt::print(stderr, "{}: waiting for rds run where the camera is\n", machine_.name);
  std::optional<Clock::time_point> over_since;
  while (!stop.stop_requested() && (!over_since || Clock::now() < *over_since + kGoodByeTime)) {
    mailbox_.wait_for(stop, kWatchPeriod, [this] { return !requests_.locked_empty(); });
    while (const auto request = requests_.try_pop()) answer(**request);
    watch();
    if (!over_since && (state_ == State::kOver || failure_)) over_since = Clock::now();
  }
  if (failure_) fmt::print(stderr, "{}\n", *failure_);
  return state_ == State::kOver && fleet_->healthy() ? 0 : 1;
}

/// A machine that is silent for long has lost its run, or its link for longer than a run stands.
void FarRun::watch() {
  if (state_ != State::kRunning) return;
  try {
    fleet_->watch();
  } catch (const Fleet::StartupFailure& failure) {
    failure_ = failure.what();
  }
  if (Clock::now() - heard_ < kSilenceLimit) return;
  failure_ = fmt::format("the machine with the camera has been silent for {} s", kSilenceLimit.count());
}

void FarRun::answer(const rds_msgs::msg::Command& request) {
  heard_ = Clock::now();
  rds_msgs::msg::CommandResult reply;
  reply.request_id(request.request_id());
  reply.service(machine_.name);
  try {
    reply.message(carry_out(request));
    reply.success(true);
  } catch (const std::exception& e) {
    reply.message(e.what());
  }
  replies_.write(reply);
}

std::string FarRun::carry_out(const rds_msgs::msg::Command& request) {
  const std::string& verb = request.verb();
  if (failure_) throw std::runtime_error(*failure_);
  if (verb == "begin") return begin(request.argument());
  if (state_ == State::kWaiting) throw std::runtime_error("no run has begun here");
  if (verb == "services") return alive();
  if (verb == "list") return list_files(folder_, request.argument());
  if (verb == "read") return read_piece(folder_, request.argument());
  if (verb == "stop") return stop_services();
  if (verb == "leave") return leave(request.argument());
  throw std::runtime_error(verb + ": not a request to a machine of a run");
}

/// The same terms may come again, where the answer was lost.
std::string FarRun::begin(const std::string& terms) {
  if (state_ == State::kWaiting) {
    RunOptions options = options_;
    accept_terms(terms, machine_, folder_, options);
    fleet_ = std::make_unique<Fleet>(service_commands(options, *options.domain, folder_));
    terms_ = terms;
    state_ = State::kRunning;
    fmt::print(stderr, "{}: a run has begun: {}\n", machine_.name, fmt::join(fleet_->names(), ", "));
  }
  if (terms != terms_) throw std::runtime_error("another run is under way here");
  return alive();
}

std::string FarRun::alive() {
  nlohmann::json alive = nlohmann::json::array();
  for (const std::string& service : fleet_->names())
    if (fleet_->alive(service)) alive.push_back(service);
  return alive.dump();
}

std::string FarRun::stop_services() {
  if (state_ == State::kRunning) fleet_->stop(kStopLimit);
  state_ = State::kStopped;
  return usage_to_json(fleet_->usage());
}

std::string FarRun::leave(const std::string& outcome) {
  stop_services();
  if (outcome.empty()) state_ = State::kOver;
  else failure_ = "the run has failed where the camera is";
  return "";
}

}  // namespace rds::run
