// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "services/mapper/core/evidence/evidence.hpp"
#include "services/mapper/core/objects/object_database.hpp"
#include "services/mapper/core/octree/semantic_octree.hpp"

namespace rds::mapper {

/// All that is made from keyframes and can be made again from them.
struct Map {
  Map(const MapperConfig& config, std::pmr::memory_resource* memory)
      : evidence(config.confirmation.apart_s, memory), octree(config.octree), objects(config.objects) {}

  Evidence evidence;
  SemanticOctree octree;  // what the evidence says
  ObjectDatabase objects;
};

/// The way of a keyframe to the map, as far as it depends on the keyframe alone: segments a sampled keyframe
/// and classifies its pixels; labels its static objects. What follows needs its pose: contribution_of(),
/// Evidence, SemanticOctree.
/// @param boxes  nullopt: nobody has looked for objects yet. Replaces what earlier boxes did.
void interpret(KeyframeRecord& record, std::optional<std::span<const LabelledBox>> boxes,
               const MapperConfig& config, LabelTable& labels);

}  // namespace rds::mapper
