// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "common/bus/participant.hpp"
#include "tools/rds/cli/secure_options.hpp"
#include "tools/rds/play/sensor_choice.hpp"

namespace rds::run {

/// The part of a run that is one machine's, where there are several.
struct Placement {
  std::set<std::string> services;  // that start here
  std::string peers;               // names or addresses of the other machines, with commas
};

/// What the user asked `rds run` for.
struct RunOptions {
  std::filesystem::path dataset;
  std::filesystem::path out;
  std::map<std::string, bus::Vendor> vendors;  // by process name; absent: default_vendor
  bus::Vendor default_vendor = bus::Vendor::kFastDds;
  double rate = 1.0;  // 0: max
  bool dynamics = true;
  std::string model;      // empty: the detector's default
  std::string model_dir;  // empty: the detector's search path
  std::filesystem::path config;
  std::size_t start = 0;
  std::size_t frames = std::numeric_limits<std::size_t>::max();
  std::filesystem::path detections;
  std::filesystem::path poses;  // empty: estimated
  play::SensorChoice sensors;   // of the robot, for the tracker
  std::filesystem::path map;    // saved map to start from, or an octree alone; empty: none
  bool map_is_octree = false;
  bool localize_only = false;
  std::optional<int> domain;   // DDS domain, to listen from outside; otherwise one that no other run uses
  bool network = false;        // seen by everybody in that domain; otherwise by loopback participants alone
  std::string node_namespace;  // of the services' topics
  std::optional<Placement> here;  // empty: all services, on this machine
  SecureOptions secure{.identities = {"operator"}};
  std::string view;        // where rds-viewer serves its page, ADDRESS:PORT or PORT; empty: nowhere
  bool view_keep = false;  // after the results, until the user stops it
  std::string frame;       // of trajectory*.txt: camera (the first one's) or map; empty: map if that is given
  bool video = false;
  bool force = false;
  std::string record;  // file that the outputs are kept in; empty: nowhere

  [[nodiscard]] bool lockstep() const { return rate == 0; }
  /// True if trajectory*.txt are in the frame of the map, as everything else is.
  [[nodiscard]] bool trajectories_in_map() const {
    return frame.empty() ? !map.empty() || !poses.empty() : frame == "map";
  }
  [[nodiscard]] bus::Vendor vendor_of(const std::string& process) const {
    const auto found = vendors.find(process);
    return found == vendors.end() ? default_vendor : found->second;
  }
};

}  // namespace rds::run
