// SPDX-License-Identifier: Apache-2.0
#include "common/service/run_service.hpp"

#include <algorithm>
#include <csignal>
#include <optional>
#include <stdexcept>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include "common/bus/names/topic_names.hpp"
#include "common/bus/peer_addresses.hpp"
#include "common/bus/security.hpp"
#include "common/bus/versions/vendor_versions.hpp"
#include "common/bus/zenoh/links/link_policy.hpp"
#include "common/command_line/document_option.hpp"
#include "common/concurrency/priority.hpp"
#include "common/service/process/freed_memory.hpp"
#include "common/service/process/stop_signals.hpp"
#include "common/service/ros/log_on_the_bus.hpp"
#include "common/service/ros/parameter_table.hpp"
#include "common/service/ros/ros_arguments.hpp"
#include "common/service/service_process.hpp"

namespace rds::service {
namespace {

struct Options {
  std::string vendor = "fastdds";
  int domain = 0;
  bool loopback_only = false;
  std::string peers;
  std::string secure;
  std::string config_path;
  std::string log_level;  // empty: as settings say
  std::string node_name;
  std::string node_namespace;
  std::string ros_distro;
  std::string frame_prefix;
  std::vector<bus::Remapping> remappings;
  YAML::Node parameters;
  double exit_when_hung_s = 0;
  bool managed = false;
};

const std::vector<std::string> kLogLevels{"trace", "debug", "info", "warning", "error"};

void add_options(CLI::App& app, Options& options) {
  app.set_version_flag("--version", [] { return RDS_VERSION "\n" + bus::vendor_versions(); });
  command_line::add_document_option(app, RDS_VERSION);
  app.add_option("--bus", options.vendor, bus::kVendorChoice)
      ->check(CLI::IsMember(std::vector<std::string>(bus::kVendorNames.begin(), bus::kVendorNames.end())));
  app.add_option("--domain", options.domain, "domain (default: ROS_DOMAIN_ID or 0)")
      ->envname("ROS_DOMAIN_ID")
      ->check(CLI::Range(0, 232));
  app.add_flag("--loopback", options.loopback_only, "this machine only");
  app.add_option("--peers", options.peers,
                 "Other machines, names or addresses: robot,nas.local,10.0.0.7; on zenoh also tcp/robot:7447")
      ->envname("RDS_PEERS");
  app.add_option("--secure", options.secure, "folder of rds secure init, for a secured domain")
      ->envname("RDS_SECURE");
  app.add_option("--config", options.config_path, "YAML file");
  app.add_option("--namespace", options.node_namespace, "Of the node and its topics, one for each robot")
      ->envname("ROS_NAMESPACE");
  app.add_option("--frame-prefix", options.frame_prefix, "Before the names of the robot's frames: robot1/");
  app.add_flag("--managed", options.managed,
               "Begin unconfigured, for a lifecycle manager of ROS 2 to activate, and hold a bond with it");
  app.add_option("--ros-distro", options.ros_distro,
                 "ROS 2 that nodes are announced to (default: as since Iron)")
      ->envname("ROS_DISTRO");
  app.add_option("--exit-when-hung", options.exit_when_hung_s,
                 "End when the worker has been silent for so long [s], for containers (default: 0, never)")
      ->envname("RDS_EXIT_WHEN_HUNG")
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--log-level", options.log_level, "Least of what is logged (default: info)")
      ->check(CLI::IsMember(kLogLevels));
}

/// Of the service itself: "rds-mapper" is "mapper".
std::optional<bus::Credentials> credentials(const std::string& name, const Options& options) {
  if (options.secure.empty()) return std::nullopt;
  auto read = bus::read_credentials(options.secure, name.substr(name.find('-') + 1));
  if (!read) throw std::runtime_error(read.error());
  return std::move(*read);
}

/// Takes what stands behind --ros-args, and what a setting of every service says.
/// @throws CLI::ValidationError
void take_ros_arguments(RosArguments&& arguments, Options& options) {
  if (arguments.node_name) options.node_name = *arguments.node_name;
  if (arguments.node_namespace) options.node_namespace = *arguments.node_namespace;
  if (arguments.log_level) options.log_level = *arguments.log_level;
  options.remappings = std::move(arguments.remappings);
  options.parameters = std::move(arguments.parameters);
  for (const auto& [name, target] :
       {std::pair("frame_prefix", &options.frame_prefix), std::pair("ros_distro", &options.ros_distro)}) {
    if (!options.parameters[name]) continue;
    if (!options.parameters[name].IsScalar())
      throw CLI::ValidationError("--ros-args", std::string(name) + ": expected a text");
    *target = options.parameters[name].as<std::string>();
    options.parameters.remove(name);
  }
  if (const YAML::Node managed = options.parameters["managed"]) {
    if (!YAML::convert<bool>::decode(managed, options.managed))
      throw CLI::ValidationError("--ros-args", "managed: expected true or false");
    options.parameters.remove("managed");
  }
  if (!options.log_level.empty()) options.parameters["log_level"] = options.log_level;
}

/// What is a setting of every service, in the form of the shipped ones.
constexpr const char* kOfEveryService =
    "frame_prefix: \"\"  # before the names of the robot's frames\n"
    "managed: false  # a lifecycle manager brings it up: it begins unconfigured, and holds a bond\n"
    "log_level: info  # least of what is logged: trace, debug, info, warning or error\n";

/// Reads the log level besides, which holds at once.
Settings::Read with_log_level(const Settings::Read& read) {
  return [read](config::ConfigReader& reader) {
    std::string level = "info";
    reader.choice("log_level", level, kLogLevels);
    Configured configured = read(reader);
    spdlog::set_level(spdlog::level::from_str(level));
    configured.live.emplace_back("log_level");
    return configured;
  };
}

/// The settings as ROS 2 asks for them.
ParameterTable parameter_table(const Settings& settings, const Options& options,
                               const std::string& shipped_settings) {
  YAML::Node given = YAML::Clone(settings.given());
  given["frame_prefix"] = options.frame_prefix;
  given["managed"] = options.managed;
  return {kOfEveryService + shipped_settings, given, settings.configured().live};
}

/// Lowers the priority of the process, and lets its threads share freed memory if that is above 0; says so
/// where the priority is not allowed. Before there are threads.
void give_way(int nice) {
  if (nice > 0) share_freed_memory();
  if (!concurrency::give_way_as_process(nice)) spdlog::warn("nice: {} is not allowed here", nice);
}

int start(const std::string& name, const Options& options, const std::string& shipped_settings,
          const Settings::Read& read) {
  Settings settings(options.config_path, options.parameters, with_log_level(read));
  give_way(settings.configured().nice);
  const bus::ParticipantOptions joining{.vendor = bus::vendor_from_name(options.vendor),
                                        .domain = options.domain,
                                        .node_name = options.node_name,
                                        .loopback_only = options.loopback_only,
                                        .peers = bus::peer_addresses(options.peers),
                                        .credentials = credentials(name, options),
                                        .node_namespace = options.node_namespace,
                                        .remappings = options.remappings,
                                        .ros_distro = bus::ros_distro_from_name(options.ros_distro)};
  bus::set_link_policy({.tell = [](const std::string& sentence) { spdlog::warn("{}", sentence); }});
  auto participant = bus::Participant::create(joining);
  Diagnostics diagnostics;
  ServiceContext context{.name = name,
                         .bus = *participant,
                         .diagnostics = diagnostics,
                         .domain = options.domain,
                         .participant = joining,
                         .node_namespace = bus::normal_namespace(options.node_namespace),
                         .frame_prefix = options.frame_prefix};
  std::optional<LogOnTheBus> log;  // permissions of a secured domain know no /rosout
  if (offers_services(joining)) log.emplace(*participant, full_node_name(context));
  if (options.managed && !offers_services(joining))
    throw std::runtime_error("--managed: expected no secured domain, which offers no services of ROS 2");
  ProcessOptions running{.exit_when_hung_s = options.exit_when_hung_s, .managed = options.managed};
  if (!shipped_settings.empty())
    running.parameters = [&] { return parameter_table(settings, options, shipped_settings); };
  ServiceProcess process(context, settings, running);
  spdlog::info("version {} on {}, domain {}, configuration {}", RDS_VERSION, options.vendor, options.domain,
               options.config_path.empty() ? "built in" : options.config_path);
  return process.run();
}

}  // namespace

int run_service(const std::string& name, int argc, char** argv, const std::string& shipped_settings,
                const Settings::Read& read,
                const std::function<void(CLI::App&, YAML::Node&)>& add_own_options) {
  const sigset_t signals =
      stop_signals();  // blocked before any thread starts, so that only sigwait sees them
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  CLI::App app{name + ", a service of RDS-SLAM", name};
  Options options;
  options.node_name = name;
  std::ranges::replace(options.node_name, '-', '_');  // ROS 2 knows no hyphens
  add_options(app, options);
  YAML::Node own_settings(YAML::NodeType::Map);
  if (add_own_options) add_own_options(app, own_settings);
  try {
    CommandLine line = split_command_line({argv + 1, argv + argc});
    std::ranges::reverse(line.own);  // as CLI11 takes them
    app.parse(std::move(line.own));
    auto ros = read_ros_arguments(line.ros, options.node_name, options.node_namespace);
    if (!ros) throw CLI::ValidationError("--ros-args", ros.error());
    take_ros_arguments(std::move(*ros), options);
    for (const auto& setting : own_settings)
      options.parameters[setting.first.as<std::string>()] = setting.second;
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  set_up_log(name);
  try {
    return start(name, options, shipped_settings, read);
  } catch (const config::ConfigError& e) {
    fmt::print(stderr, "{}\n", e.what());
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}: {}\n", name, e.what());
  }
  return 2;
}

}  // namespace rds::service
