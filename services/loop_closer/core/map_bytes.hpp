// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <tl/expected.hpp>

#include "common/map_file/byte_writer.hpp"

namespace rds::loop_closer {

/// The keyframes of two saved maps as those of one: LoopCloser::to_bytes() of both.
/// @param first_of_later  what is added to the ids of the later map's. Keyframes of the earlier map from that
/// id on came while it was being saved, and are left out.
/// @return or what is wrong with the bytes.
tl::expected<map_file::Bytes, std::string> merge_maps(std::span<const std::uint8_t> earlier,
                                                      std::span<const std::uint8_t> later,
                                                      std::uint64_t first_of_later);

}  // namespace rds::loop_closer
