// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/commander/commander.hpp"

#include <random>

#include "common/topics/endpoints.hpp"

namespace rds::run {
namespace {

constexpr topics::Process kSender = topics::kPlayer | topics::kTool;

std::uint64_t random_id() {
  std::random_device device;
  return (static_cast<std::uint64_t>(device()) << 32) | device();
}

}  // namespace

Commander::Commander(bus::Participant& bus)
    : next_id_(random_id()),
      commands_(topics::advertise(bus, topics::kCommand, kSender)),
      results_(topics::subscribe(bus, topics::kCommandResult, kSender, [this](const auto& m) {
        const std::lock_guard lock(mutex_);
        const auto request = replies_.find(m->request_id());
        if (request == replies_.end()) return;  // somebody else's, or too late
        request->second[m->service()] = {m->success(), m->message()};
        changed_.notify_all();
      })) {}

std::uint64_t Commander::send(const std::string& service, const std::string& verb,
                              const std::string& argument) {
  rds_msgs::msg::Command command;
  {
    const std::lock_guard lock(mutex_);
    command.request_id(++next_id_);
    replies_[command.request_id()];
  }
  command.target(service);
  command.verb(verb);
  command.argument(argument);
  commands_.write(command);
  return command.request_id();
}

std::optional<CommandReply> Commander::ask(const std::string& service, const std::string& verb,
                                           const std::string& argument, const std::stop_token& stop,
                                           std::chrono::milliseconds limit) {
  const std::uint64_t id = send(service, verb, argument);
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, stop, limit, [&] { return !replies_[id].empty(); });
  const auto answers = replies_.extract(id);
  if (answers.mapped().empty()) return std::nullopt;
  return answers.mapped().begin()->second;
}

std::map<std::string, std::string> Commander::ask_status(std::size_t expected, const std::stop_token& stop,
                                                         std::chrono::milliseconds limit) {
  const std::uint64_t id = send("", "status", "");
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, stop, limit, [&] { return replies_[id].size() >= expected; });
  std::map<std::string, std::string> status;
  const auto answers = replies_.extract(id);
  for (const auto& [service, reply] : answers.mapped()) status[service] = reply.message;
  return status;
}

}  // namespace rds::run
