// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "services/mapper/core/objects/map_object.hpp"
#include "services/mapper/core/octree/label_table.hpp"
#include "services/mapper/core/octree/semantic_octree.hpp"

namespace rds::mapper {

/// Gives each object the extent of the voxels that bear its label in and around the box that its sightings
/// have told.
///
/// One view shows a part of an object, and something of what stands before or behind it. The votes of all
/// views on a voxel are of neither: what most of them took for something else is not the object's, and a back
/// that few views showed counts as much as the front. A voxel is of the nearest object of its label. Objects
/// without voxels keep their box.
void fit_to_voxels(std::span<MapObject> objects, const SemanticOctree& octree, const LabelTable& labels);

}  // namespace rds::mapper
