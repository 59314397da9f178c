// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/config_reader.hpp"
#include "common/store/maps_folder.hpp"
#include "services/mapper/core/config/mapper_config.hpp"

namespace rds::mapper {

struct MapperServiceConfig {
  int nice = 10;                 // the tracker has the processor first
  bool lockstep = false;         // no keyframe is ever dropped, and none integrated without its boxes
  bool expect_boxes = true;      // a keyframe waits for its boxes …
  double boxes_timeout_s = 1.0;  // … until one newer by this has come; later boxes act at the next correction
  int full_map_every = 20;       // keyframes, while somebody reads; besides, whenever somebody new subscribes
  std::string map_file;             // saved map, or OctoMap tree, that it starts from; empty: none
  bool localize_only = false;       // neither keyframes nor boxes are listened to
  store::MapsConfig maps;           // where the map lasts
  MapperConfig mapper;

  bool operator==(const MapperServiceConfig&) const = default;
};

void read(config::ConfigReader& reader, MapperServiceConfig& config);

}  // namespace rds::mapper
