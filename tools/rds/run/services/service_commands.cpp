// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/services/service_commands.hpp"

#include <stdexcept>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "common/config/config_reader.hpp"
#include "common/topics/topics.hpp"
#include "services/detector/detector_service_config.hpp"
#include "services/loop_closer/loop_closer_service_config.hpp"
#include "services/mapper/mapper_service_config.hpp"
#include "services/tracker/tracker_service_config.hpp"
#include "services/transformer/transformer_service_config.hpp"
#include "services/viewer/viewer_service_config.hpp"
#include "tools/rds/run/output/result_file.hpp"
#include "tools/rds/topology/topology.hpp"

namespace rds::run {
namespace fs = std::filesystem;
namespace {

struct Section {
  std::string process;
  std::string key;
};

const std::vector<Section>& sections() {
  static const std::vector<Section> kSections{{kTracker, "tracker"},
                                              {kDetector, "detector"},
                                              {kTransformer, "transformer"},
                                              {kMapper, "mapper"},
                                              {kLoopCloser, "loop_closer"}};
  return kSections;
}

template <class Config>
void check(config::ConfigReader& services, const std::string& key) {
  Config config;
  read(services.section(key), config);
}

/// The user's file, a map of services' settings.
/// @throws config::ConfigError naming every key and value, of all services, that no service would take.
YAML::Node read_user_config(const fs::path& file) {
  if (file.empty()) return YAML::Node(YAML::NodeType::Map);
  auto reader = config::ConfigReader::from_file(file);
  check<tracker::TrackerServiceConfig>(reader, "tracker");
  check<detector::DetectorServiceConfig>(reader, "detector");
  check<transformer::TransformerServiceConfig>(reader, "transformer");
  check<mapper::MapperServiceConfig>(reader, "mapper");
  check<loop_closer::LoopCloserServiceConfig>(reader, "loop_closer");
  check<viewer::ViewerServiceConfig>(reader, "viewer");
  reader.finish();
  return YAML::LoadFile(file);
}

/// Takes the command line's word into one service's configuration.
void complete(YAML::Node& node, const std::string& process, const RunOptions& options,
              const fs::path& folder) {
  if (process != kTransformer) node["lockstep"] = options.lockstep();
  if (process == kTracker) node["dynamics"] = options.dynamics;
  if (process == kTracker && options.sensors.odometry)
    node["inputs"]["odometry"] = topics::kRobotOdometry.name;
  if (process == kTracker && options.sensors.imu) node["inputs"]["imu"] = topics::kImu.name;
  if (process == kTracker && !options.poses.empty())
    node["poses_file"] = fs::absolute(options.poses).string();
  if (process == kMapper && !options.poses.empty() && !node["grid"]["up"])
    node["grid"]["up"] = "surfaces";  // whoever gave the poses chose the map's frame
  if (process == kMapper) node["expect_boxes"] = options.dynamics;
  const bool keeps_map = process == kTracker || process == kMapper || process == kLoopCloser;
  if (keeps_map && !options.map.empty() && (process == kMapper || !options.map_is_octree))
    node["map_file"] = fs::absolute(options.map).string();
  if (keeps_map) node["localize_only"] = options.localize_only;
  if (keeps_map) node["maps_dir"] = (folder / kMapsFolder).string();
  if (keeps_map) node["backup_s"] = 0;  // for a process that starts again, not for a disk that errs
  if (process != kDetector) return;
  if (!options.model.empty()) node["network"] = options.model;
  if (!options.model_dir.empty()) node["model_dir"] = fs::absolute(options.model_dir).string();
  if (!options.detections.empty()) node["detections_file"] = fs::absolute(options.detections).string();
}

YAML::Node section_of(const YAML::Node& user, const std::string& key) {
  return user[key] ? YAML::Clone(user[key]) : YAML::Node(YAML::NodeType::Map);
}

fs::path write_config(const YAML::Node& node, const fs::path& file) {
  write_result(file, YAML::Dump(node) + '\n');
  return file;
}

/// The command that starts a process of the run with these settings.
ServiceCommand command_of(const std::string& process, const YAML::Node& settings, const RunOptions& options,
                          int domain, const fs::path& folder) {
  const fs::path executables = fs::read_symlink("/proc/self/exe").parent_path();
  fs::create_directories(folder / "config");
  fs::create_directories(folder / "log");
  const fs::path config = write_config(settings, folder / "config" / (process + ".yaml"));
  std::vector<std::string> line{(executables / process).string(),
                                "--bus",
                                bus::name_of(options.vendor_of(process)),
                                "--domain",
                                std::to_string(domain),
                                "--config",
                                config.string()};
  if (!options.network) line.emplace_back("--loopback");
  if (options.here) line.insert(line.end(), {"--peers", options.here->peers});
  if (!options.node_namespace.empty()) line.insert(line.end(), {"--namespace", options.node_namespace});
  if (!options.secure.folder.empty())
    line.insert(line.end(), {"--secure", fs::absolute(options.secure.folder).string()});
  return {process, std::move(line), folder / "log" / (process + ".log")};
}

}  // namespace

std::set<std::string> services_of(const RunOptions& options) {
  std::set<std::string> services{kTracker, kMapper};
  if (options.dynamics) services.insert({kDetector, kTransformer});
  if (options.poses.empty()) services.insert(kLoopCloser);
  return services;
}

std::vector<ServiceCommand> service_commands(const RunOptions& options, int domain, const fs::path& folder) {
  const YAML::Node user = read_user_config(options.config);
  const std::set<std::string> services = options.here ? options.here->services : services_of(options);
  std::vector<ServiceCommand> commands;
  for (const auto& [process, key] : sections()) {
    if (!services.contains(process)) continue;
    YAML::Node node = section_of(user, key);
    complete(node, process, options, folder);
    commands.push_back(command_of(process, node, options, domain, folder));
  }
  return commands;
}

ServiceCommand viewer_command(const RunOptions& options, int domain, const fs::path& folder) {
  YAML::Node node = section_of(read_user_config(options.config), "viewer");
  node["listen"] = options.view;
  return command_of(kViewer, node, options, domain, folder);
}

}  // namespace rds::run
