// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/domain_lock.hpp"
#include "common/commander/commander.hpp"
#include "common/image/tum_dataset.hpp"
#include "tests/hosts/arrivals.hpp"
#include "tests/hosts/figures.hpp"
#include "tests/hosts/host_routers.hpp"
#include "tests/hosts/hosts_table.hpp"
#include "tests/hosts/on_core.hpp"
#include "tools/rds/play/player.hpp"
#include "tools/rds/run/results/recorder.hpp"
#include "tools/rds/run/services/fleet.hpp"

namespace rds::test {

/// One row: its hosts, its services, a camera at the recorded speed and a recorder.
class HostsTrial {
 public:
  /// @param out  a new folder: trajectories, map.ot, what each service said, and for each host the logs,
  /// settings and maps of its services. @throws std::runtime_error when the services do not come together.
  HostsTrial(const Row& row, const std::filesystem::path& recording, std::filesystem::path out);

  /// @return figures without scores.
  HostFigures run();

 private:
  [[nodiscard]] bool is_late(const std::string& host) const;
  [[nodiscard]] std::vector<run::ServiceCommand> commands(bool late) const;
  [[nodiscard]] std::unique_ptr<bus::Participant> join() const;
  [[nodiscard]] std::string peers_of(const std::string& host) const;
  void add_second_reader();
  [[nodiscard]] std::uint64_t idle_bytes() const;
  [[nodiscard]] std::filesystem::path folder_of(const std::string& host) const { return out_ / host; }
  void wait_until_connected();
  void play();
  void be_absent(double at_s);
  void replace(const std::string& host);
  void drain();
  void save_map();
  std::string ask(const std::string& service, const std::string& verb, const std::string& argument);
  void note_statuses();

  Row row_;
  std::filesystem::path out_;
  image::TumDataset dataset_;
  std::filesystem::path poses_;  // given to the tracker; empty: it finds its own
  HostNetwork network_;
  HostRouters routers_;
  OnHost here_;  // all that follows is on A
  OnCore core_;
  bus::DomainLock domain_;
  std::unique_ptr<bus::Participant> bus_;
  run::Recorder recorder_;
  commander::Commander commander_;
  Arrivals arrivals_;
  play::Player camera_;
  run::Fleet fleet_;
  std::int64_t last_stamp_ns_ = 0;  // of the camera
  enum class Phase { kBefore, kDuring, kAfter } phase_ = Phase::kBefore;
  std::unique_ptr<Process> second_reader_;  // of the camera
  HostFigures figures_;
};

}  // namespace rds::test
