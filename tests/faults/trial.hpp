// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/domain_lock.hpp"
#include "common/image/tum_dataset.hpp"
#include "tests/faults/faulty_camera.hpp"
#include "tests/faults/process_fault.hpp"
#include "tools/rds/run/results/recorder.hpp"
#include "tools/rds/run/services/run_options.hpp"

namespace rds::test {

/// Five services as processes on a bus of their own, a camera at the recorded speed, and one fault.
class Trial {
 public:
  /// How services ended, and what they did not answer.
  struct Report {
    std::map<std::string, std::vector<int>> ends;  // by service, exit statuses that nobody asked for
    std::vector<std::string> faults;               // sentences
    std::size_t frames = 0;                        // sent
    std::size_t localized = 0;                     // with a pose
    std::size_t keyframes = 0;                     // of the map at the end
    std::size_t integrated = 0;                    // into the octree
  };

  /// @param out  a new folder: trajectories, map.ot, logs. @param patience  times the usual limits, for
  /// slow builds. @throws std::runtime_error when the services do not come together.
  Trial(const std::filesystem::path& recording, const Row& row, const Timing& timing,
        const std::filesystem::path& out, int patience = 1);

  Report run();

 private:
  [[nodiscard]] run::RunOptions options(const std::filesystem::path& recording) const;
  std::vector<run::ServiceCommand> commands();
  void wait_until_connected();
  void play();
  void expect_living_workers();
  void drain();
  void save_map();
  std::string ask(const std::string& service, const std::string& verb, const std::string& argument);
  void write_results();
  [[nodiscard]] std::chrono::milliseconds patient(std::chrono::milliseconds limit) const {
    return limit * patience_;
  }

  Row row_;
  Timing timing_;
  std::filesystem::path out_;
  int patience_;
  image::TumDataset dataset_;
  run::RunOptions options_;
  bus::DomainLock domain_;
  std::unique_ptr<bus::Participant> bus_;
  run::Recorder recorder_;
  commander::Commander commander_;
  FaultyCamera camera_;
  FailingDisk disk_;
  std::vector<run::ServiceCommand> commands_;
  run::Fleet fleet_;
  Report report_;
};

}  // namespace rds::test
