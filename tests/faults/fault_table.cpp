// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/fault_table.hpp"

#include <algorithm>
#include <iterator>

#include "tests/support/bus/vendors.hpp"

namespace rds::test {
namespace {

using Services = std::vector<std::string>;

const std::string kCamera;
const Services kAll{"rds-tracker", "rds-detector", "rds-transformer", "rds-mapper", "rds-loop-closer"};
const Services kWithMap{"rds-tracker", "rds-mapper", "rds-loop-closer"};
const std::vector<Moment> kMoments{{"begin", 3}, {"middle", 8}, {"end", 13}};
const std::vector<std::string> kRecordings{"rpy", "walkers"};

struct Kind {
  Fault fault;
  std::string name;
  Services services;
};

const std::vector<Kind> kKinds{
    {Fault::kKill, "kill", kAll},
    {Fault::kKillTwice, "kill_twice", kAll},
    {Fault::kStop, "stop", kAll},
    {Fault::kStarve, "starve", kAll},
    {Fault::kRestart, "restart", kAll},
    {Fault::kTwin, "twin", kAll},
    {Fault::kDiskFull, "disk_full", kWithMap},
    {Fault::kDiskError, "disk_error", kWithMap},
    {Fault::kClockBack, "clock_back", {kCamera}},
    {Fault::kClockAhead, "clock_ahead", {kCamera}},
    {Fault::kCameraGap, "gap", {kCamera}},
    {Fault::kFramesLost, "lost_frames", {kCamera}},
    {Fault::kFramesMixed, "mixed_frames", {kCamera}},
};

/// A fault of a service meets each vendor, and from one service to the next each moment does.
std::vector<Row> make_table() {
  std::vector<Row> rows;
  std::size_t first_turn = 0;
  for (const Kind& kind : kKinds)
    for (const std::string& service : kind.services) {
      std::size_t turn = first_turn++;
      for (const Moment& moment : kMoments) {
        const std::string& recording = kRecordings[turn / kAllVendors.size() % kRecordings.size()];
        rows.push_back(
            {rows.size(), kind.fault, kind.name, service, moment, recording, vendor_in_turn(turn++)});
      }
    }
  return rows;
}

/// "loop_closer" of "rds-loop-closer".
std::string short_name(const std::string& service) {
  std::string name = service.empty() ? "camera" : service.substr(4);
  std::ranges::replace(name, '-', '_');
  return name;
}

}  // namespace

std::string Row::label() const {
  const std::string what = fault == Fault::kNone ? name : name + "_" + short_name(service);
  return what + "_" + moment.name + "_" + bus::name_of(vendor) + "_" + recording;
}

std::vector<int> Row::expected_ends() const {
  switch (fault) {
    case Fault::kKill:
      return {137};
    case Fault::kKillTwice:
      return {137, 137};
    case Fault::kRestart:
      return {0};
    default:
      return {};
  }
}

void PrintTo(const Row& row, std::ostream* out) {
  *out << row.label();
}

const std::vector<Row>& fault_table() {
  static const std::vector<Row> kTable = make_table();
  return kTable;
}

std::vector<Row> rows_at_begin() {
  std::vector<Row> rows;
  std::ranges::copy_if(fault_table(), std::back_inserter(rows),
                       [](const Row& row) { return row.moment.name == kMoments.front().name; });
  return rows;
}

std::vector<Row> undisturbed_rows() {
  std::vector<Row> rows;
  for (const Moment& moment : kMoments)
    for (const std::string& recording : kRecordings)
      for (const bus::Vendor vendor : kAllVendors)
        rows.push_back({rows.size(), Fault::kNone, "undisturbed", kCamera, moment, recording, vendor});
  return rows;
}

}  // namespace rds::test
