// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "common/bus/domain_lock.hpp"
#include "common/commander/commander.hpp"
#include "common/image/tum_dataset.hpp"
#include "tests/hosts/arrivals.hpp"
#include "tests/hosts/host_network.hpp"
#include "tests/hosts/maps/revisions.hpp"
#include "tools/rds/play/player.hpp"
#include "tools/rds/run/services/fleet.hpp"

namespace rds::test {

/// Who reads the map on the slow machine: two of these.
enum class SlowReaders { kNone, kTopics, kTransfer };

struct MapRow {
  bus::Vendor vendor = bus::Vendor::kFastDds;
  SlowReaders readers = SlowReaders::kNone;
  int rate_mbit = 5;  // of the slow machine's link, both ways

  /// For GoogleTest.
  [[nodiscard]] std::string label() const;
};
void PrintTo(const MapRow& row, std::ostream* out);

struct MapFigures {
  std::vector<FollowerFigures> followers;  // on the slow machine
  double offered_mbit_s = 0;               // what the fast machine sent to its link
  double mapper_cpu = 0;                   // cores
  double near_p50_ms = 0;                  // from a keyframe to its delta, at a reader beside the mapper
  double near_p95_ms = 0;
  double boxes_p50_ms = 0;  // from a keyframe to its boxes
  double boxes_p95_ms = 0;
  double gap_s = 0;  // longest time between two tracking states
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MapFigures, followers, offered_mbit_s, mapper_cpu, near_p50_ms,
                                   near_p95_ms, boxes_p50_ms, boxes_p95_ms, gap_s)

std::string to_line(const MapRow& row, const MapFigures& figures);

/// Five services, a camera at its recorded speed and a reader of the map on one machine; slow readers on
/// another, which come when there is a map.
class MapTrial {
 public:
  /// @param out  a new folder: logs, settings and maps of the services.
  MapTrial(const MapRow& row, const std::filesystem::path& recording, std::filesystem::path out);

  MapFigures run();

 private:
  std::vector<run::ServiceCommand> commands() const;
  [[nodiscard]] std::string peers_of(const std::string& host) const;
  void wait_until_connected();
  void play();
  void start_readers();

  MapRow row_;
  std::filesystem::path out_;
  image::TumDataset dataset_;
  HostNetwork network_;
  OnHost here_;  // all that follows is on the fast machine
  bus::DomainLock domain_;
  std::unique_ptr<bus::Participant> bus_;
  commander::Commander commander_;
  Arrivals arrivals_;
  Revisions revisions_;
  play::Player camera_;
  run::Fleet fleet_;
  std::vector<std::unique_ptr<Process>> followers_;
};

}  // namespace rds::test
