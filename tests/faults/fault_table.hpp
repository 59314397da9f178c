// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

#include "common/bus/participant.hpp"

namespace rds::test {

/// What is done to a process, or to the camera's pictures.
enum class Fault {
  kNone,
  kKill,         // SIGKILL
  kKillTwice,    // again 2 s later, while it takes its map back
  kStop,         // SIGSTOP, then SIGCONT
  kStarve,       // runs a quarter of the time only
  kRestart,      // SIGTERM; whoever looks after it starts it again
  kTwin,         // a second one with the same settings, for a while
  kDiskFull,     // ENOSPC on every write below the folder of maps, and a `save` meanwhile
  kDiskError,    // the same with EIO
  kClockBack,    // the camera's stamps go on 1000 s earlier
  kClockAhead,   // … 1000 s later
  kCameraGap,    // no pictures
  kFramesLost,   // each message of the camera is lost with a probability of 0.4
  kFramesMixed,  // each message of the camera comes 0 to 2 frames late
};

/// When a fault begins [s], counted from the first picture.
struct Moment {
  std::string name;
  double at_s = 0;
};

/// How a fault is tried: what is played, and how long the fault lasts [s of the recording].
struct Timing {
  double at_s = 0;
  double lasts_s = 5;
  double total_s = 0;
  double rate = 1.0;  // times recorded speed
};

/// One row of the table.
struct Row {
  std::size_t index = 0;  // also the seed
  Fault fault = Fault::kNone;
  std::string name;     // of the fault
  std::string service;  // "rds-mapper" …; empty: the camera
  Moment moment;
  std::string recording;  // "rpy" or "walkers"
  bus::Vendor vendor = bus::Vendor::kFastDds;

  /// fault, service, moment, vendor and recording: a name for GoogleTest.
  [[nodiscard]] std::string label() const;
  /// Played on for 10 s after a fault of 5 s.
  [[nodiscard]] Timing timing() const { return {.at_s = moment.at_s, .total_s = moment.at_s + 15}; }
  /// Exit statuses of the service that the fault itself causes.
  [[nodiscard]] std::vector<int> expected_ends() const;
};

void PrintTo(const Row& row, std::ostream* out);

/// All rows: faults × services × moments, vendors and recordings in turn.
const std::vector<Row>& fault_table();
/// Those of the first moment.
std::vector<Row> rows_at_begin();
/// The run without a fault that rows of each vendor, recording and moment are compared with.
std::vector<Row> undisturbed_rows();

}  // namespace rds::test
