// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "services/mapper/core/objects/map_object.hpp"

namespace rds::mapper {

/// objects.json: [{id, label, labels: [{label, probability}], score, center, size, oriented: {center, size,
/// yaw, orientation}, observations, movable, first_seen, last_seen, gone}], metres with 4 decimals, stamps in
/// seconds. `center` and `size` are along the map's axes. `oriented` is MapObject::upright: yaw [rad], and as
/// orientation the quaternion (x, y, z, w) of map_from_box.
std::string to_json(std::span<const MapObject> objects);

}  // namespace rds::mapper
