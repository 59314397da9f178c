// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/services/fleet.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

namespace rds::run {
namespace {

constexpr int kBadUsage = 2;

std::string contents(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  std::string all = text.str();
  while (!all.empty() && all.back() == '\n') all.pop_back();
  return all;
}

}  // namespace

Fleet::Fleet(std::vector<ServiceCommand> services) {
  for (ServiceCommand& service : services) start(std::move(service));
}

void Fleet::start(ServiceCommand service) {
  usage_[service.name] = {};
  ChildProcess process(service.command, service.log);
  members_.push_back({std::move(service), std::move(process)});
}

void Fleet::account(const std::string& name, const ChildExit& exit) {
  ServiceUsage& usage = usage_[name];
  usage.cpu_s += exit.cpu_s;
  usage.peak_bytes = std::max(usage.peak_bytes, exit.peak_bytes);
}

void Fleet::watch() {
  for (Member& member : members_) {
    if (member.given_up || !member.process.poll()) continue;
    const std::string& name = member.service.name;
    const ChildExit exit = *member.process.poll();
    if (exit.status == kBadUsage) throw StartupFailure(contents(member.service.log));
    account(name, exit);
    ServiceUsage& usage = usage_[name];
    usage.failures.push_back(exit.status);
    member.given_up = usage.restarts >= kMaxRestarts;
    fmt::print(stderr, "{} ended with status {}{} (its log: {})\n", name, exit.status,
               member.given_up ? " and is given up" : ", it is started again", member.service.log.string());
    if (member.given_up) continue;
    ++usage.restarts;
    member.process = ChildProcess(member.service.command, member.service.log);
  }
}

void Fleet::stop(std::chrono::milliseconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  for (Member& member : members_) member.process.ask_to_stop();
  for (Member& member : members_) {
    if (member.given_up) continue;
    const ChildExit exit = member.process.wait_or_kill(deadline);
    account(member.service.name, exit);
    if (exit.status != 0) usage_[member.service.name].failures.push_back(exit.status);
    member.given_up = true;
  }
}

std::set<std::string> Fleet::names() const {
  std::set<std::string> names;
  for (const auto& [name, usage] : usage_) names.insert(name);
  return names;
}

bool Fleet::healthy() const {
  return std::ranges::all_of(usage_, [](const auto& entry) { return entry.second.failures.empty(); });
}

bool Fleet::alive(const std::string& name) {
  const auto member = std::ranges::find_if(members_, [&](const Member& m) { return m.service.name == name; });
  return member != members_.end() && !member->given_up && !member->process.poll();
}

}  // namespace rds::run
