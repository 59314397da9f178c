// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/far/far_machines.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "common/service/random_id.hpp"
#include "common/topics/topics.hpp"
#include "tools/rds/run/far/terms.hpp"
#include "tools/rds/run/far/usage.hpp"
#include "tools/rds/run/output/result_file.hpp"
#include "tools/rds/run/services/service_commands.hpp"

namespace rds::run {
namespace {

using namespace std::chrono_literals;

constexpr auto kBeginLimit = 60s;
constexpr auto kAnswerLimit = 1s;
constexpr auto kSilenceLimit = 15s;
constexpr auto kStopLimit = 15s;
constexpr int kAttempts = 20;                   // for what a bad link has lost
constexpr std::size_t kPiecesUnderWay = 64;     // fewer than the history of the topic

}  // namespace

FarMachines::FarMachines(bus::Participant& bus, const RunOptions& options, const hosts::HostsFile& hosts,
                         const std::string& here)
    : commander_(bus, topics::kRunRequest, topics::kRunReply) {
  const std::string run = fmt::format("{:016x}", service::random_id());
  const std::set<std::string> wanted = services_of(options);
  for (const hosts::Machine& machine : hosts.machines) {
    Machine far{.terms = terms_of(options, hosts, machine.name, run)};
    std::ranges::set_intersection(machine.services, wanted, std::inserter(far.services, far.services.end()));
    if (machine.name != here && !far.services.empty()) machines_[machine.name] = std::move(far);
  }
}

FarMachines::~FarMachines() {
  listener_ = {};
  for (const auto& [name, machine] : machines_)
    if (machine.has_begun) commander_.ask(name, "leave", "failed", {}, kAnswerLimit);
}

void FarMachines::begin(const std::stop_token& stop) {
  const auto deadline = Clock::now() + kBeginLimit;
  std::set<std::string> waiting;
  for (const auto& [name, machine] : machines_) waiting.insert(name);
  if (!waiting.empty()) fmt::print(stderr, "waiting for rds run --hosts on {}\n", fmt::join(waiting, ", "));
  while (!waiting.empty() && !stop.stop_requested()) {
    for (auto& [name, machine] : machines_) {
      if (!waiting.contains(name)) continue;
      const auto reply = commander_.ask(name, "begin", machine.terms, stop, kAnswerLimit);
      if (!reply) continue;
      if (!reply->success) throw std::runtime_error(fmt::format("{}: {}", name, reply->message));
      machine.alive = machine.services;
      machine.has_begun = true;
      waiting.erase(name);
    }
    if (!waiting.empty() && Clock::now() > deadline)
      throw std::runtime_error(fmt::format("{} did not answer within {} s: expected rds run --hosts there",
                                           fmt::join(waiting, ", "), kBeginLimit.count()));
  }
  for (auto& [name, machine] : machines_) machine.heard = Clock::now();
  listener_ = std::jthread([this](const std::stop_token& listener_stop) { listen(listener_stop); });
}

/// Asks each machine once a second how its services are; so it knows, too, that this one is there.
void FarMachines::listen(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const auto next = Clock::now() + kAnswerLimit;
    for (auto& [name, machine] : machines_) {
      const auto reply = commander_.ask(name, "services", "", stop, kAnswerLimit);
      if (!reply) continue;
      const auto alive = nlohmann::json::parse(reply->message, nullptr, false);
      const std::lock_guard lock(mutex_);
      machine.heard = Clock::now();
      if (!reply->success) machine.failure = reply->message;
      else if (alive.is_array()) machine.alive = alive.get<std::set<std::string>>();
    }
    while (!stop.stop_requested() && Clock::now() < next) std::this_thread::sleep_for(50ms);
  }
}

void FarMachines::watch() const {
  const std::lock_guard lock(mutex_);
  for (const auto& [name, machine] : machines_) {
    if (!machine.failure.empty()) throw std::runtime_error(fmt::format("{}: {}", name, machine.failure));
    if (Clock::now() - machine.heard > kSilenceLimit)
      throw std::runtime_error(fmt::format("{} has been silent for {} s", name, kSilenceLimit.count()));
  }
}

std::set<std::string> FarMachines::services() const {
  std::set<std::string> all;
  for (const auto& [name, machine] : machines_) all.insert(machine.services.begin(), machine.services.end());
  return all;
}

bool FarMachines::alive(const std::string& service) const {
  const std::lock_guard lock(mutex_);
  return std::ranges::any_of(machines_, [&](const auto& m) { return m.second.alive.contains(service); });
}

std::string FarMachines::ask(const std::string& machine, const std::string& verb, const std::string& argument,
                             std::chrono::milliseconds limit, const std::stop_token& stop) {
  const auto reply = commander_.ask(machine, verb, argument, stop, limit);
  if (!reply || !reply->success)
    throw std::runtime_error(fmt::format("{} {}: {}", machine, verb, reply ? reply->message : "no answer"));
  return reply->message;
}

void FarMachines::fetch(const std::string& prefix, const std::filesystem::path& to,
                        const std::stop_token& stop) {
  for (const auto& [name, machine] : machines_)
    for (const FileEntry& file : parse_files(ask(name, "list", prefix, kStopLimit, stop))) {
      std::filesystem::create_directories((to / file.path).parent_path());
      write_result(to / file.path, read(name, file, stop));
    }
}

/// Of pieces that a bad link has lost, the first and those after it are asked for again.
std::string FarMachines::read(const std::string& machine, const FileEntry& file, const std::stop_token& stop) {
  std::string content;
  int attempts = 0;
  while (content.size() < file.bytes) {
    std::vector<std::string> requests;
    for (std::uint64_t at = content.size(); at < file.bytes && requests.size() < kPiecesUnderWay;
         at += kPieceBytes)
      requests.push_back(piece_request(file, at));
    for (const auto& reply : commander_.ask_each(machine, "read", requests, stop, 2 * kAnswerLimit)) {
      if (!reply) break;
      if (!reply->success) throw std::runtime_error(fmt::format("{}: {}", machine, reply->message));
      const std::uint64_t left = file.bytes - content.size();
      content += parse_piece(reply->message, std::min<std::uint64_t>(kPieceBytes, left));
      attempts = 0;
    }
    if (stop.stop_requested() || ++attempts > kAttempts)
      throw std::runtime_error(fmt::format("{}: {} did not arrive", machine, file.path));
  }
  return content;
}

std::map<std::string, ServiceUsage> FarMachines::stop_services(const std::stop_token& stop) {
  listener_ = {};
  std::map<std::string, ServiceUsage> usage;
  for (const auto& [name, machine] : machines_)
    usage.merge(usage_from_json(ask(name, "stop", "", kStopLimit, stop)));
  return usage;
}

void FarMachines::leave(const std::stop_token& stop) {
  for (auto& [name, machine] : machines_) {
    ask(name, "leave", "", kStopLimit, stop);
    machine.has_begun = false;
  }
}

}  // namespace rds::run
