// SPDX-License-Identifier: Apache-2.0
#include "common/service/ros/rosout.hpp"

#include <chrono>
#include <utility>

#include "common/messages/conversions.hpp"

namespace rds::service {
namespace {

using rcl_interfaces::msg::Log;
namespace Level = rcl_interfaces::msg::Log_Constants;

constexpr bus::Qos kRosout{.reliable = true, .transient_local = true, .depth = 1000};  // as rclcpp's

thread_local bool writes_lines = false;

std::uint8_t level_of(spdlog::level::level_enum level) {
  switch (level) {
    case spdlog::level::trace:
    case spdlog::level::debug:
      return Level::DEBUG;
    case spdlog::level::warn:
      return Level::WARN;
    case spdlog::level::err:
      return Level::ERROR;
    case spdlog::level::critical:
      return Level::FATAL;
    default:
      return Level::INFO;
  }
}

}  // namespace

Rosout::Rosout(bus::Participant& bus, std::string name)
    : name_(std::move(name)),
      publisher_(bus.advertise<Log>("/rosout", kRosout)),  // of every node, so in no table
      lines_(mailbox_, kMostWaiting),
      thread_([this](const std::stop_token& stop) { write(stop); }) {}

Rosout::~Rosout() {
  thread_.request_stop();
  thread_.join();
}

void Rosout::sink_it_(const spdlog::details::log_msg& line) {
  if (writes_lines) return;
  Log log;
  log.stamp(messages::to_time(std::chrono::nanoseconds(line.time.time_since_epoch()).count()));
  log.level(level_of(line.level));
  log.name(name_);
  log.msg(std::string(line.payload.begin(), line.payload.end()));
  lines_.push(std::move(log));
}

void Rosout::write(const std::stop_token& stop) {
  writes_lines = true;
  while (mailbox_.wait(stop, [this] { return !lines_.locked_empty(); }))
    while (const auto line = lines_.try_pop()) publisher_.write(*line);
  while (const auto line = lines_.try_pop()) publisher_.write(*line);
}

}  // namespace rds::service
