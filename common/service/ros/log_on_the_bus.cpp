// SPDX-License-Identifier: Apache-2.0
#include "common/service/ros/log_on_the_bus.hpp"

#include <algorithm>

#include <spdlog/sinks/dist_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace rds::service {
namespace {

/// "robot1.rds_tracker" of the node /robot1/rds_tracker, as in ROS.
std::string logger_of(const std::string& node) {
  std::string name = node.substr(1);
  std::ranges::replace(name, '/', '.');
  return name;
}

/// Of set_up_log(); others may come and go.
spdlog::sinks::dist_sink_mt& sinks() {
  return dynamic_cast<spdlog::sinks::dist_sink_mt&>(*spdlog::default_logger_raw()->sinks().front());
}

}  // namespace

void set_up_log(const std::string& name) {
  auto sinks = std::make_shared<spdlog::sinks::dist_sink_mt>();
  sinks->add_sink(std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
  auto logger = std::make_shared<spdlog::logger>(name, sinks);
  logger->set_pattern("%Y-%m-%dT%H:%M:%S.%e %n %^%l%$ %v");
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(logger);
}

LogOnTheBus::LogOnTheBus(bus::Participant& bus, const std::string& node)
    : rosout_(std::make_shared<Rosout>(bus, logger_of(node))) {
  sinks().add_sink(rosout_);
}

LogOnTheBus::~LogOnTheBus() {
  sinks().remove_sink(rosout_);
}

}  // namespace rds::service
