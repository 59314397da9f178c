// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/bus/participant.hpp"

#ifndef RDS_HAS_ZENOH
#error "rds_runs_on_zenoh(TARGET), in CMakeLists.txt, says whether Zenoh is among the vendors"
#endif

namespace rds::test {

/// What tests run on; Zenoh where it is built.
inline constexpr std::array kAllVendors {
  bus::Vendor::kFastDds, bus::Vendor::kCycloneDds,
#if RDS_HAS_ZENOH
      bus::Vendor::kZenoh,
#endif
};

/// For cases of which each is run on one vendor.
inline bus::Vendor vendor_in_turn(std::size_t index) {
  return kAllVendors.at(index % kAllVendors.size());
}

/// For ValuesIn, where a test gives the name to programs.
inline std::vector<std::string> all_vendor_names() {
  std::vector<std::string> names;
  for (const bus::Vendor vendor : kAllVendors) names.push_back(bus::name_of(vendor));
  return names;
}

/// Names of test cases whose parameter is a vendor, or its name.
inline std::string vendor_name(const testing::TestParamInfo<bus::Vendor>& tested) {
  return bus::name_of(tested.param);
}
inline std::string given_name(const testing::TestParamInfo<std::string>& tested) {
  return tested.param;
}

}  // namespace rds::test
