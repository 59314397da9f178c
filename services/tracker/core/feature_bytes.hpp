// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/map_file/byte_reader.hpp"
#include "common/map_file/byte_writer.hpp"
#include "services/tracker/core/feature.hpp"

namespace rds::tracker {

/// Bytes of a feature.
inline constexpr std::size_t kFeatureBytes = 24 + 2 + sizeof(Descriptor);

/// @param movable_now  what its keyframe knows of it by now.
void put(map_file::ByteWriter& writer, const Feature& feature, bool movable_now);

/// Refuses impossible values. @param levels  of the image pyramid.
Feature get_feature(map_file::ByteReader& reader, int levels, bool& movable_now);

}  // namespace rds::tracker
