// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "services/mapper/core/evidence/evidence.hpp"
#include "services/mapper/core/objects/map_object.hpp"
#include "services/mapper/core/octree/label_table.hpp"
#include "services/mapper/core/octree/semantic_octree.hpp"

namespace rds::mapper {

/// Gives each object the extent of the voxels that bear a label of its in and around its box: a label that
/// has a good part of the evidence, for of an object that is seen as two kinds of thing some voxels bear
/// either.
///
/// A sighting shows a part of an object, and something of what overlaps it in the picture. The voxels' votes
/// are of all views: overlaps are outvoted, and a back that few views showed counts as much as the front. A
/// voxel belongs to the nearest object that has been seen with its label. Objects without voxels keep their
/// box.
/// @param up  unit vector against gravity in the map: the direction about which MapObject::upright is turned.
void fit_to_voxels(std::span<MapObject> objects, const SemanticOctree& octree, const LabelTable& labels,
                   const Eigen::Vector3d& up);

/// Says of objects that were seen through whether they have gone: of the voxels in and around an object's box
/// that keyframes have given its label, most are free.
void find_gone(std::span<MapObject> objects, const Evidence& evidence, const SemanticOctree& octree,
               const LabelTable& labels);

}  // namespace rds::mapper
