// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <tl/expected.hpp>

#include "common/map_file/byte_reader.hpp"
#include "common/map_file/byte_writer.hpp"
#include "services/tracker/core/calibration/self_calibration.hpp"
#include "services/tracker/core/config/tracker_config.hpp"
#include "services/tracker/core/map/map_contents.hpp"

namespace rds::tracker {

/// A map to go on in, and the camera it was made with.
struct SavedMap {
  SlamMap map;
  KnownCamera camera;
};

/// Who sees a map point.
void put(map_file::ByteWriter& writer, const std::vector<Observation>& observations);
std::vector<Observation> get_observations(map_file::ByteReader& reader);

/// What of a map cannot be computed again: what is known of the camera, keyframes with their features, map
/// points and who sees what. Poses are kept apart, as keyframe_poses() gives them. Submaps, which have no
/// place in the map, are left out.
map_file::Bytes to_bytes(const SlamMap& map, const KnownCamera& camera, const ExtractionConfig& extraction);

/// The image pyramid of the features in such bytes. @return or what is wrong with it.
tl::expected<ExtractionConfig, std::string> pyramid_of(std::span<const std::uint8_t> bytes);

/// The map that these bytes and poses describe, all its keyframes fixed. Ids of keyframes stay; those of
/// points count anew. Covisibility and what is known of each point's appearance are computed from the
/// observations.
///
/// @return or what is wrong with the bytes: cut short, another pyramid of features, indices of what is not
/// there.
tl::expected<SavedMap, std::string> map_from_bytes(std::span<const std::uint8_t> bytes,
                                                   std::span<const KeyframePose> poses,
                                                   const ExtractionConfig& extraction);

}  // namespace rds::tracker
