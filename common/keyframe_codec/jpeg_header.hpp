// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace rds::keyframe_codec {

/// Whether the bytes begin as a JPEG that is decoded row by row: sequential (SOF0, SOF1), 8 bits, three
/// components, all of them in the first scan. Of others a decoder keeps coefficients of the whole picture,
/// and a few hundred bytes can tell it to go over them hundreds of times. Source: ITU-T T.81, Annex B.
bool has_one_sequential_scan(std::span<const std::uint8_t> data);

}  // namespace rds::keyframe_codec
