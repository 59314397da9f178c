// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <tl/expected.hpp>

#include "common/map_file/byte_writer.hpp"
#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// A record packed without loss: differences of depth, runs of equal classes, labels and surfaces. Neither
/// pose nor rays are in it.
map_file::Bytes to_bytes(const KeyframeRecord& record);

/// @return the record without pose and rays, or what is wrong with the bytes.
tl::expected<KeyframeRecord, std::string> record_from_bytes(std::span<const std::uint8_t> bytes);

}  // namespace rds::mapper
