// SPDX-License-Identifier: Apache-2.0
#include "common/commander/commander.hpp"

#include <algorithm>

#include "common/service/random_id.hpp"
#include "common/topics/endpoints.hpp"

namespace rds::commander {
namespace {

/// Whoever commands, as the table says.
topics::Process sender_of(const topics::Topic<rds_msgs::msg::Command>& commands) {
  return commands.writers.begin()->processes;
}

}  // namespace

Commander::Commander(bus::Participant& bus, const topics::Topic<rds_msgs::msg::Command>& commands,
                     const topics::Topic<rds_msgs::msg::CommandResult>& results)
    : next_id_(service::random_id()),
      commands_(topics::advertise(bus, commands, sender_of(commands))),
      results_(topics::subscribe(bus, results, sender_of(commands), [this](const auto& m) {
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
  return ask_each(service, verb, {argument}, stop, limit).front();
}

std::vector<std::optional<CommandReply>> Commander::ask_each(const std::string& service,
                                                             const std::string& verb,
                                                             const std::vector<std::string>& arguments,
                                                             const std::stop_token& stop,
                                                             std::chrono::milliseconds limit) {
  std::vector<std::uint64_t> ids;
  for (const std::string& argument : arguments) ids.push_back(send(service, verb, argument));
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, stop, limit, [&] {
    return std::ranges::none_of(ids, [&](std::uint64_t id) { return replies_[id].empty(); });
  });
  std::vector<std::optional<CommandReply>> replies;
  for (const std::uint64_t id : ids) {
    const auto answers = replies_.extract(id);
    const bool none = answers.mapped().empty();
    replies.push_back(none ? std::nullopt : std::optional(answers.mapped().begin()->second));
  }
  return replies;
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

}  // namespace rds::commander
