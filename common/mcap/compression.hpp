// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "common/mcap/records.hpp"

namespace rds::mcap {

enum class Compression { kNone, kLz4, kZstd };

/// As the format writes it: "", "lz4", "zstd".
std::string name_of(Compression compression);
/// nullopt for another name.
std::optional<Compression> compression_from_name(std::string_view name);

/// Compresses a chunk's records: an LZ4 frame, or a Zstandard frame of level 1.
/// @param buffer  for the result, of any content: one for all chunks costs no memory for each of them.
/// @return the result in the buffer, or the records where nothing is to be compressed.
/// @throws std::bad_alloc
View compress(View records, Compression compression, Bytes& buffer);

/// @param size  that the records have to have. Memory grows with what really comes out of `compressed`, never
/// beyond that.
/// @return or what is wrong: torn, foreign, of another size.
tl::expected<Bytes, std::string> decompress(View compressed, Compression compression, std::size_t size);

/// CRC-32 (IEEE 802.3), as the format has it everywhere.
std::uint32_t crc32_of(View bytes);

}  // namespace rds::mcap
