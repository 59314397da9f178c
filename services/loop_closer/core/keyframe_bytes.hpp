// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <tl/expected.hpp>

#include "common/map_file/byte_writer.hpp"
#include "services/loop_closer/core/loop_types.hpp"

namespace rds::loop_closer {

/// What LoopCloser::add() was given, all of it.
map_file::Bytes to_bytes(const KeyframeFeatures& keyframe);

/// @return the keyframe, or what is wrong with the bytes.
tl::expected<KeyframeFeatures, std::string> keyframe_from_bytes(std::span<const std::uint8_t> bytes);

}  // namespace rds::loop_closer
