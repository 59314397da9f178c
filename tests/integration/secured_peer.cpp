// SPDX-License-Identifier: Apache-2.0
// Somebody beside the services, for secured_bus_test.cpp: hears what it can and tries to command.
//   secured_peer VENDOR DOMAIN SECONDS VERB [FOLDER IDENTITY]
// reads some topics, sends the command VERB to the tracker twice a second, until every topic that it may read
// has brought something or so many seconds are over, and writes one line
//   {"samples": {topic: number}, "refused": [topic, ...]}
// to standard output; "refused" are the topics that it may not read or write. Without FOLDER it has no
// certificate.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <iostream>
#include <list>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/bus/participant.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "octomap_msgs/msg/Octomap.h"
#include "rds_msgs/msg/Command.h"
#include "rds_msgs/msg/CommandResult.h"
#include "rds_msgs/msg/TrackingState.h"
#include "sensor_msgs/msg/Image.h"

namespace {

using rds::bus::Participant;
using Clock = std::chrono::steady_clock;

/// Counts a topic's samples, if it may.
class Ear {
 public:
  explicit Ear(std::string name) : topic(std::move(name)) {}

  template <class Message>
  void listen(Participant& participant, const rds::bus::Qos& qos) {
    try {
      subscription_ = participant.subscribe<Message>(
          topic, qos, [this](const std::shared_ptr<const Message>& /*message*/) { ++samples; });
    } catch (const rds::bus::BusError& /*refused*/) {
      refused = true;
    }
  }

  std::string topic;
  std::atomic<int> samples = 0;
  bool refused = false;

 private:
  rds::bus::Subscription subscription_;  // last: its callback uses the others
};

class Peer {
 public:
  explicit Peer(Participant& participant) {
    listen<sensor_msgs::msg::Image>(participant, "camera/color/image_raw", rds::bus::kSensor);
    listen<rds_msgs::msg::TrackingState>(participant, "rds/tracking_state", rds::bus::kStream);
    listen<nav_msgs::msg::Odometry>(participant, "rds/odometry", rds::bus::kStream);
    listen<octomap_msgs::msg::Octomap>(participant, "rds/map/full", rds::bus::kLatched);
    listen<rds_msgs::msg::CommandResult>(participant, "rds/command_result", rds::bus::kStream);
    try {
      commands_ = participant.advertise<rds_msgs::msg::Command>("rds/command", rds::bus::kStream);
      may_command_ = true;
    } catch (const rds::bus::BusError& /*refused*/) {
    }
  }

  void command(const std::string& verb) {
    if (!may_command_) return;
    rds_msgs::msg::Command command;
    command.request_id(++requests_);
    command.target("rds-tracker");
    command.verb(verb);
    commands_.write(command);
  }

  [[nodiscard]] bool has_heard_all() const {
    return std::ranges::all_of(ears_, [](const Ear& ear) { return ear.refused || ear.samples > 0; });
  }

  [[nodiscard]] nlohmann::json report() const {
    nlohmann::json json{{"samples", nlohmann::json::object()}, {"refused", nlohmann::json::array()}};
    for (const Ear& ear : ears_) {
      json["samples"][ear.topic] = ear.samples.load();
      if (ear.refused) json["refused"].push_back(ear.topic);
    }
    if (!may_command_) json["refused"].push_back("rds/command");
    return json;
  }

 private:
  template <class Message>
  void listen(Participant& participant, const std::string& topic, const rds::bus::Qos& qos) {
    ears_.emplace_back(topic).listen<Message>(participant, qos);
  }

  std::list<Ear> ears_;
  rds::bus::Publisher<rds_msgs::msg::Command> commands_;
  bool may_command_ = false;
  std::uint64_t requests_ = 0;
};

int run(const std::vector<std::string>& arguments) {
  rds::bus::ParticipantOptions options{.vendor = rds::bus::vendor_from_name(arguments.at(0)),
                                       .domain = std::stoi(arguments.at(1)),
                                       .node_name = "secured_peer",
                                       .loopback_only = true};
  if (arguments.size() > 4) {
    auto credentials = rds::bus::read_credentials(arguments.at(4), arguments.at(5));
    if (!credentials) throw std::runtime_error(credentials.error());
    options.credentials = *credentials;
  }
  const auto participant = Participant::create(options);
  Peer peer(*participant);
  const auto end = Clock::now() + std::chrono::seconds(std::stoi(arguments.at(2)));
  while (Clock::now() < end && !peer.has_heard_all()) {
    peer.command(arguments.at(3));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
  std::cout << peer.report().dump() << std::endl;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(std::vector<std::string>(argv + 1, argv + argc));
  } catch (const std::exception& error) {
    std::cerr << "secured_peer: " << error.what() << '\n';
    return 2;
  }
}
