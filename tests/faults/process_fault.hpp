// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <future>
#include <optional>
#include <string>

#include "common/commander/commander.hpp"
#include "tests/faults/fault_table.hpp"
#include "tools/rds/run/services/fleet.hpp"

namespace rds::test {

/// Makes writes of the row's service below the folder of maps fail, for its children started from now on;
/// nothing for rows of other faults.
class FailingDisk {
 public:
  FailingDisk(const Row& row, const std::filesystem::path& place);
  ~FailingDisk();
  FailingDisk(const FailingDisk&) = delete;
  FailingDisk& operator=(const FailingDisk&) = delete;

  /// From now on, with ENOSPC or EIO.
  void arm(Fault fault);
  void disarm();

 private:
  std::filesystem::path armed_;
};

/// What is done to one process of this program's children, at its time.
class ProcessFault {
 public:
  /// @param command  how the service is started.
  ProcessFault(const Row& row, const Timing& timing, run::ServiceCommand command,
               commander::Commander& commander, FailingDisk& disk);

  /// To be called with every frame. @param at_s  since the first frame [s of the recording].
  void act(double at_s);

  /// After the last frame: what has not been as it should be, one sentence; empty if all was.
  std::string verdict();

 private:
  void begin();
  void go_on(double since_begin_s);
  void end();
  void send(int signal);
  void try_to_save();

  Row row_;
  Timing timing_;
  run::ServiceCommand command_;
  commander::Commander& commander_;
  FailingDisk& disk_;
  enum class Phase { kBefore, kDuring, kAfter } phase_ = Phase::kBefore;
  bool killed_again_ = false;
  bool is_stopped_ = false;
  std::optional<run::ChildProcess> twin_;
  std::future<std::optional<commander::CommandReply>> saved_;
  std::string missed_;  // a process that was not there
};

}  // namespace rds::test
