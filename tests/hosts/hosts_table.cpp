// SPDX-License-Identifier: Apache-2.0
#include "tests/hosts/hosts_table.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "tests/support/bus/vendors.hpp"

namespace rds::test {
namespace {

constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr double kLongS = 55;           // 5 before an absence of 20, 30 after it
constexpr double kLongestS = 95;        // and of 60
constexpr double kLateS = 60;           // 30 before who comes late, 30 after
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
  const auto absent = [](std::string name, Absence absence, double length_s) {
    return Row{.name = std::move(name),
               .absence = std::move(absence),
               .bounds = {.p95_ms = kAny, .map_share = kAfterAbsence},
               .length_s = length_s};
  };
  const auto routed = [](std::string name, Way way, Link link) {
    return Row{
        .name = std::move(name), .link = link, .bounds = {.p95_ms = 500}, .has_multicast = false, .way = way};
  };
  Row no_router = absent("router_killed", {.host = "R", .kind = Absence::Kind::kNoRouter}, kLongS);
  no_router.has_multicast = false;
  no_router.way = Way::kRouters;
  return {rate("clean", 1000, {.p95_ms = 150}),
          rate("rate_100", 100, {.p95_ms = 200}),
          rate("rate_40", 40, {.p95_ms = 300}),
          rate("rate_20", 20, {.answered = 0.9, .p95_ms = 600}),
          absent("c_away", {.host = "C", .for_s = 10}, kLongS),
          absent("c_away_20", {.host = "C", .for_s = 20}, kLongS),
          absent("b_away_10", {.host = "B", .for_s = 10}, kLongS),
          absent("b_away", {.host = "B", .for_s = 20}, kLongS),
          absent("b_away_60", {.host = "B", .for_s = 60}, kLongestS),
          absent("c_away_60", {.host = "C", .for_s = 60}, kLongestS),
          absent("c_replaced", {.host = "C", .kind = Absence::Kind::kReplaced}, kLongS),
          absent("c_late", {.host = "C", .kind = Absence::Kind::kLate, .from_s = 0, .for_s = 30}, kLateS),
          impaired("loss_0_1", 1000, {.loss = 0.001}, {.p95_ms = 150}),
          impaired("loss_1", 1000, {.loss = 0.01}, {.p95_ms = 200}),
          impaired("loss_5", 1000, {.loss = 0.05}, {.answered = 0.95, .p95_ms = 600}),
          impaired("jitter", 1000, {.delay_ms = 20, .jitter_ms = 10}, {.p95_ms = 300}),
          impaired("rate_40_loss_1", 40, {.delay_ms = 3, .loss = 0.01}, {.p95_ms = 500}),
          Row{.name = "by_address", .has_multicast = false},
          Row{.name = "bystanders", .has_bystanders = true},
          Row{.name = "clocks_apart", .clock_shift_s = 300},
          routed("router", Way::kRouter, {}),
          routed("routers", Way::kRouters, {}),
          routed("routers_rate_40_loss_1", Way::kRouters,
                 {.rate_mbit = 40, .impairment = {.delay_ms = 3, .loss = 0.01}}),
          no_router};
}

/// Routers are Zenoh's, which in turn does not go by multicast between machines.
bool fits(const Row& row, bus::Vendor vendor) {
  return vendor == bus::Vendor::kZenoh ? row.has_multicast || row.way != Way::kDirect
                                       : row.way == Way::kDirect;
}

Row of(Row row, bus::Vendor vendor) {
  row.vendor = vendor;
  row.has_multicast = row.has_multicast && vendor != bus::Vendor::kZenoh;
  return row;
}

bool is_short(const Row& row) {
  constexpr std::array kNames{"clean", "rate_40", "loss_1", "by_address", "c_away", "routers"};
  return std::ranges::find(kNames, row.name) != kNames.end();
}

}  // namespace

Row on_one_machine(const Row& row) {
  return {.name = row.length_s > 0 ? fmt::format("one_machine_{:.0f}_s", row.length_s) : "one_machine",
          .vendor = row.vendor,
          .on_one_machine = true,
          .length_s = row.length_s};
}

void PrintTo(const Row& row, std::ostream* out) {
  *out << row.label();
}

std::vector<Row> one_machine_rows() {
  std::vector<Row> rows;
  for (const bus::Vendor vendor : kAllVendors)
    for (const double length_s : {0.0, kLongS, kLateS, kLongestS})
      rows.push_back(on_one_machine({.vendor = vendor, .length_s = length_s}));
  return rows;
}

std::vector<Row> short_rows() {
  std::vector<Row> rows;
  std::size_t next = 0;
  for (const Row& row : kinds()) {
    if (!is_short(row) || std::ranges::none_of(kAllVendors, [&](auto vendor) { return fits(row, vendor); }))
      continue;
    while (!fits(row, vendor_in_turn(next))) ++next;
    rows.push_back(of(row, vendor_in_turn(next++)));
  }
  return rows;
}

CoreRows core_rows(bus::Vendor vendor) {
  return {of({.name = "cores_split", .cores = Cores::kOfEachHost}, vendor),
          {.name = "cores_beside", .vendor = vendor, .on_one_machine = true, .cores = Cores::kOfEachHost},
          {.name = "cores_shared", .vendor = vendor, .on_one_machine = true, .cores = Cores::kOne},
          {.name = "cores_alone", .vendor = vendor, .on_one_machine = true, .cores = Cores::kOneForTracker}};
}

std::vector<Row> all_rows() {
  std::vector<Row> rows;
  for (const bus::Vendor vendor : kAllVendors)
    for (const Row& row : kinds())
      if (fits(row, vendor)) rows.push_back(of(row, vendor));
  return rows;
}

}  // namespace rds::test
