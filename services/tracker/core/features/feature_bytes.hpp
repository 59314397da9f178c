// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/map_file/byte_reader.hpp"
#include "common/map_file/byte_writer.hpp"
#include "services/tracker/core/config/tracker_config.hpp"
#include "services/tracker/core/features/feature.hpp"

namespace rds::tracker {

/// Bytes of a feature.
inline constexpr std::size_t kFeatureBytes = 24 + 2 + sizeof(Descriptor);

/// Features are found again on the same image pyramid only.
void put_pyramid(map_file::ByteWriter& writer, const ExtractionConfig& extraction);
/// The levels and their factor; refuses impossible ones.
ExtractionConfig get_pyramid(map_file::ByteReader& reader);
/// Refuses another one than this.
void expect_pyramid(map_file::ByteReader& reader, const ExtractionConfig& extraction);

/// @param movable_now  what its keyframe knows of it by now.
void put(map_file::ByteWriter& writer, const Feature& feature, bool movable_now);

/// Refuses impossible values. @param levels  of the image pyramid.
Feature get_feature(map_file::ByteReader& reader, int levels, bool& movable_now);

}  // namespace rds::tracker
