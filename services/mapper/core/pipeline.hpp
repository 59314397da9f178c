// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "services/mapper/core/evidence/scene_history.hpp"
#include "services/mapper/core/objects/object_database.hpp"
#include "services/mapper/core/octree/semantic_octree.hpp"

namespace rds::mapper {

/// All that is made from keyframes and can be made again from them.
struct Map {
  explicit Map(const MapperConfig& config)
      : octree(config.octree),
        objects(config.objects),
        history{{}, DynamicHistory(config.octree.resolution_m)} {}

  SemanticOctree octree;
  ObjectDatabase objects;
  SceneHistory history;
};

// The way of a keyframe into the map. interpret() looks at the keyframe alone; add_evidence() and
// update_map() need its pose. Where many keyframes make a map again, all of them add their evidence first.

/// Segments a sampled keyframe and classifies its pixels; labels its static objects.
/// @param boxes  nullopt: nobody has looked for objects yet. Replaces what earlier boxes did.
void interpret(KeyframeRecord& record, std::optional<std::span<const LabelledBox>> boxes,
               const MapperConfig& config, LabelTable& labels);

/// Adds a keyframe to what is known of when its voxels were static or dynamic, and to the objects.
void add_evidence(const KeyframeRecord& record, const MapperConfig& config, const LabelTable& labels,
                  Map& map);

/// Decides the unconfirmed pixels, casts the rays and updates the octree.
/// @param history  of all keyframes. @param scan  scratch memory. @param delta  receives what changed.
void update_map(const KeyframeRecord& record, const SceneHistory& history, const MapperConfig& config,
                const LabelTable& labels, Scan& scan, Map& map, MapDelta& delta);

/// Adds the occupied voxels of a saved map to its history: they count as seen at all times.
void add_saved_surfaces(Map& map);

}  // namespace rds::mapper
