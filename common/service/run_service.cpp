// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <optional>
#include <stdexcept>

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "common/bus/peer_addresses.hpp"
#include "common/bus/security.hpp"
#include "common/concurrency/priority.hpp"
#include "common/service/process/freed_memory.hpp"
#include "common/service/process/stop_signals.hpp"
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
  std::string log_level = "info";
  double exit_when_hung_s = 0;
};

void set_up_log(const std::string& name, const std::string& level) {
  auto logger = spdlog::stderr_color_mt(name);
  logger->set_pattern("%Y-%m-%dT%H:%M:%S.%e %n %^%l%$ %v");
  logger->set_level(spdlog::level::from_str(level));
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(logger);
}

void add_options(CLI::App& app, Options& options) {
  app.set_version_flag("--version", RDS_VERSION);
  app.add_option("--bus", options.vendor, "fastdds or cyclonedds")
      ->check(CLI::IsMember({"fastdds", "cyclonedds"}));
  app.add_option("--domain", options.domain, "DDS domain (default: ROS_DOMAIN_ID or 0)")
      ->envname("ROS_DOMAIN_ID")
      ->check(CLI::Range(0, 232));
  app.add_flag("--loopback", options.loopback_only, "this machine only");
  app.add_option("--peers", options.peers, "Other machines, names or addresses: robot,nas.local,10.0.0.7")
      ->envname("RDS_PEERS");
  app.add_option("--secure", options.secure, "folder of rds secure init, for a secured domain")
      ->envname("RDS_SECURE");
  app.add_option("--config", options.config_path, "YAML file");
  app.add_option("--exit-when-hung", options.exit_when_hung_s,
                 "End when the worker has been silent for so long [s], for containers (default: 0, never)")
      ->envname("RDS_EXIT_WHEN_HUNG")
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--log-level", options.log_level)
      ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error"}));
}

/// Of the service itself: "rds-mapper" is "mapper".
std::optional<bus::Credentials> credentials(const std::string& name, const Options& options) {
  if (options.secure.empty()) return std::nullopt;
  auto read = bus::read_credentials(options.secure, name.substr(name.find('-') + 1));
  if (!read) throw std::runtime_error(read.error());
  return std::move(*read);
}

int start(const std::string& name, const Options& options,
          const std::function<ServiceFactory(config::ConfigReader&)>& read) {
  auto reader = options.config_path.empty() ? config::ConfigReader()
                                            : config::ConfigReader::from_file(options.config_path);
  const ServiceFactory factory = read(reader);
  const bus::ParticipantOptions joining{.vendor = bus::vendor_from_name(options.vendor),
                                        .domain = options.domain,
                                        .node_name = name,
                                        .loopback_only = options.loopback_only,
                                        .peers = bus::peer_addresses(options.peers),
                                        .credentials = credentials(name, options)};
  auto participant = bus::Participant::create(joining);
  Diagnostics diagnostics;
  ServiceContext context{.name = name,
                         .bus = *participant,
                         .diagnostics = diagnostics,
                         .domain = options.domain,
                         .participant = joining};
  ServiceProcess process(context, factory, options.exit_when_hung_s);
  spdlog::info("version {} on {}, domain {}, configuration {}", RDS_VERSION, options.vendor, options.domain,
               options.config_path.empty() ? "built in" : options.config_path);
  return process.run();
}

}  // namespace

void give_way(int nice) {
  if (nice > 0) share_freed_memory();
  if (!concurrency::give_way_as_process(nice)) spdlog::warn("nice: {} is not allowed here", nice);
}

int run_service(const std::string& name, int argc, char** argv,
                const std::function<ServiceFactory(config::ConfigReader&)>& read,
                const std::function<void(CLI::App&)>& add_own_options) {
  const sigset_t signals =
      stop_signals();  // blocked before any thread starts, so that only sigwait sees them
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  CLI::App app{name + ", a service of RDS-SLAM"};
  Options options;
  add_options(app, options);
  if (add_own_options) add_own_options(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  set_up_log(name, options.log_level);
  try {
    return start(name, options, read);
  } catch (const config::ConfigError& e) {
    fmt::print(stderr, "{}\n", e.what());
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}: {}\n", name, e.what());
  }
  return 2;
}

}  // namespace rds::service
