// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/config_reader.hpp"
#include "common/store/maps_folder.hpp"
#include "services/loop_closer/core/loop_closer_config.hpp"

namespace rds::loop_closer {

struct LoopCloserServiceConfig {
  int nice = 10;               // the tracker has the processor first
  bool lockstep = false;       // no keyframe is ever dropped
  std::string map_file;        // saved map whose keyframes it starts from; empty: none
  bool localize_only = false;  // what is saved is the map_file; keyframes that come are forgotten
  store::MapsConfig maps;      // where the keyframes last
  LoopCloserConfig loop_closer;

  bool operator==(const LoopCloserServiceConfig&) const = default;
};

void read(config::ConfigReader& reader, LoopCloserServiceConfig& config);

}  // namespace rds::loop_closer
