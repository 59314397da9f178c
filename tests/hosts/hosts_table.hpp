// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "common/bus/participant.hpp"
#include "tests/hosts/host_network.hpp"

namespace rds::test {

/// A host that is not there for a while [s after the first picture].
struct Absence {
  enum class Kind {
    kUnplugged,  // its link is pulled out, and plugged in again
    kReplaced,   // its services are killed, and start at once with an empty disk
    kLate,       // its services start for the first time at the end of the absence
    kNoRouter,   // its router is killed, and started again
  };
  std::string host = {};
  Kind kind = Kind::kUnplugged;
  double from_s = 5;
  double for_s = 10;
};

/// What a row has to show.
struct Bounds {
  double answered = 0.98;   // share of the keyframes whose boxes arrive
  double p95_ms = 150;      // … within, for 95 of 100
  double map_share = 0.02;  // recall less, residue more than on one machine, at most
};

/// On which processor cores the hosts' programs may run.
enum class Cores {
  kAny,
  kOfEachHost,     // A's on the first, those of B and C on the second
  kOne,            // all on the first
  kOneForTracker,  // the tracker on the first; no other service runs
};

/// How the hosts reach each other.
enum class Way {
  kDirect,
  kRouter,   // by a router on a host R; nobody can dial A, as behind NAT, whose programs only dial R
  kRouters,  // the same, but they dial a router on A, and only that dials R
};

/// One row: five services on three hosts, A (camera, tracker, recorder), B (detector, transformer) and
/// C (mapper, loop closer), or all on A.
struct Row {
  std::string name = {};
  bus::Vendor vendor = bus::Vendor::kFastDds;
  bool on_one_machine = false;
  Link link = {};  // of A
  std::optional<Absence> absence = {};
  Bounds bounds = {};
  /// So long to and fro, so that there are 30 s after an absence [s]; 0: the recording as it is.
  double length_s = 0;
  bool has_multicast = true;    // without, the hosts know each other's addresses, or the router's
  bool has_bystanders = false;  // a fourth host where nothing runs; a second reader of the camera on A
  Cores cores = Cores::kAny;    // what feeds the camera is on the second
  Way way = Way::kDirect;
  int clock_shift_s = 0;  // by which B's clock is set late, and C's early

  /// The tracker is given the true poses where an absence may cost the map .01: with its own, one machine's
  /// map differs from run to run by .04, and by .15 where tracking among people forks.
  [[nodiscard]] bool poses_are_given() const { return length_s > 0; }
  /// Name and vendor, for GoogleTest.
  [[nodiscard]] std::string label() const { return name + "_" + bus::name_of(vendor); }
};

/// The row on one machine that this one is compared with.
Row on_one_machine(const Row& row);

void PrintTo(const Row& row, std::ostream* out);

/// Each vendor and length on one machine.
std::vector<Row> one_machine_rows();
/// Clean, 40 Mbit/s, 1 % of loss, without multicast, C away for 10 s, by two routers.
std::vector<Row> short_rows();
/// All.
std::vector<Row> all_rows();
/// A vendor's rows of the reason for it all: A's programs have a core for themselves, have it on a machine
/// where the others have the other core, share it with them, and the tracker alone has it.
struct CoreRows {
  Row split;
  Row beside;
  Row shared;
  Row alone;
};
CoreRows core_rows(bus::Vendor vendor);

}  // namespace rds::test
