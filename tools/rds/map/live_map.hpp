// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include <octomap/ColorOcTree.h>
#include <tl/expected.hpp>

#include "common/bus/participant.hpp"

namespace rds::tools {

/// The newest full map on the bus.
struct LiveMap {
  std::unique_ptr<octomap::ColorOcTree> tree;
  std::uint64_t map_epoch = 0;  // 0 if nobody tells
  std::uint64_t revision = 0;
  std::vector<std::string> labels;  // label table; empty if nobody tells
};

/// Takes the map that rds/map/full holds ready, and what rds/map/info says of it; from another machine by
/// transfer, at the pace of the link.
///
/// @return or one sentence: no map in time, a map that cannot be decoded.
tl::expected<LiveMap, std::string> take_live_map(bus::Participant& participant,
                                                 std::chrono::duration<double> timeout,
                                                 const std::stop_token& stop);

}  // namespace rds::tools
