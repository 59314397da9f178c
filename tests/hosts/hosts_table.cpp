// SPDX-License-Identifier: Apache-2.0
#include "tests/hosts/hosts_table.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>

namespace rds::test {
namespace {

using Kind = Absence::Kind;

constexpr std::array kVendors{bus::Vendor::kFastDds, bus::Vendor::kCycloneDds};
constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr double kAfterAbsence = 0.01;  // of recall and residue, 30 s later

/// Of one vendor, and without name of it.
std::vector<Row> kinds() {
  const auto rate = [](std::string name, int mbit, Bounds bounds) {
    return Row{.name = std::move(name), .link = {.rate_mbit = mbit}, .bounds = bounds};
  };
  const auto impaired = [](std::string name, int mbit, Impairment impairment, Bounds bounds) {
    return Row{
        .name = std::move(name), .link = {.rate_mbit = mbit, .impairment = impairment}, .bounds = bounds};
  };
  const auto absent = [](std::string name, std::string host, Kind kind) {
    return Row{.name = std::move(name),
               .absence = Absence{.host = std::move(host), .kind = kind},
               .bounds = {.p95_ms = kAny, .map_share = kAfterAbsence},
               .is_long = true};
  };
  return {rate("clean", 1000, {.p95_ms = 150}),
          rate("rate_100", 100, {.p95_ms = 200}),
          rate("rate_40", 40, {.p95_ms = 300}),
          rate("rate_20", 20, {.answered = 0.9, .p95_ms = 600}),
          impaired("loss_0_1", 1000, {.loss = 0.001}, {.p95_ms = 150}),
          impaired("loss_1", 1000, {.loss = 0.01}, {.p95_ms = 200}),
          impaired("loss_5", 1000, {.loss = 0.05}, {.answered = 0.95, .p95_ms = 600}),
          impaired("jitter", 1000, {.delay_ms = 20, .jitter_ms = 10}, {.p95_ms = 300}),
          impaired("rate_40_loss_1", 40, {.delay_ms = 3, .loss = 0.01}, {.p95_ms = 500}),
          absent("c_away", "C", Kind::kUnplugged),
          absent("b_away", "B", Kind::kUnplugged),
          absent("c_replaced", "C", Kind::kReplaced)};
}

bool is_short(const Row& row) {
  constexpr std::array kNames{"clean", "rate_40", "loss_1", "c_away"};
  return std::ranges::find(kNames, row.name) != kNames.end();
}

}  // namespace

Row on_one_machine(const Row& row) {
  return {.name = row.is_long ? "one_machine_long" : "one_machine",
          .vendor = row.vendor,
          .on_one_machine = true,
          .is_long = row.is_long};
}

void PrintTo(const Row& row, std::ostream* out) {
  *out << row.label();
}

std::vector<Row> one_machine_rows() {
  std::vector<Row> rows;
  for (const bus::Vendor vendor : kVendors)
    for (const bool is_long : {false, true})
      rows.push_back(on_one_machine({.vendor = vendor, .is_long = is_long}));
  return rows;
}

std::vector<Row> short_rows() {
  std::vector<Row> rows;
  std::ranges::copy_if(all_rows(), std::back_inserter(rows), is_short);
  return rows;
}

std::vector<Row> all_rows() {
  std::vector<Row> rows;
  for (const bus::Vendor vendor : kVendors)
    for (Row& row : kinds()) rows.emplace_back(std::move(row)).vendor = vendor;
  return rows;
}

}  // namespace rds::test
