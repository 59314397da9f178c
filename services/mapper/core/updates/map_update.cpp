// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/updates/map_update.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <stdexcept>

#include <zstd.h>

#include "common/map_file/byte_reader.hpp"
#include "common/map_file/byte_writer.hpp"
#include "services/mapper/core/octree/label_table.hpp"
#include "services/mapper/core/updates/morton.hpp"

namespace rds::mapper {
namespace {

using map_file::ByteReader;
using map_file::ByteWriter;
using Bytes = std::vector<std::uint8_t>;

constexpr int kLevel = 3;  // of zstd: beyond, twice the time for a twentieth less
constexpr unsigned kVarintBits = 7;
constexpr std::size_t kMinVoxelBytes = 10;  // a distance and the values

void put_varint(ByteWriter& writer, std::uint64_t value) {
  for (; value >> kVarintBits != 0; value >>= kVarintBits)
    writer.put(static_cast<std::uint8_t>(value | 1U << kVarintBits));
  writer.put(static_cast<std::uint8_t>(value));
}

std::uint64_t get_varint(ByteReader& reader) {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64 && reader.ok(); shift += kVarintBits) {
    const auto byte = reader.get<std::uint8_t>();
    value |= static_cast<std::uint64_t>(byte & ((1U << kVarintBits) - 1)) << shift;
    if (byte >> kVarintBits == 0) return value;
  }
  reader.refuse("a distance without end");
  return 0;
}

/// Distances from one code to the next, less one.
void put_keys(ByteWriter& writer, const std::vector<std::uint16_t>& keys) {
  std::uint64_t next = 0;
  for (std::size_t i = 0; i + 2 < keys.size(); i += 3) {
    const std::uint64_t code = morton_of({keys[i], keys[i + 1], keys[i + 2]});
    if (code < next) throw std::invalid_argument("an update's voxels are not in Morton order");
    put_varint(writer, code - next);
    next = code + 1;
  }
}

std::vector<std::uint16_t> get_keys(ByteReader& reader, std::size_t count) {
  std::vector<std::uint16_t> keys;
  keys.reserve(3 * count);
  std::uint64_t next = 0;
  for (std::size_t i = 0; i < count && reader.ok(); ++i) {
    const std::uint64_t distance = get_varint(reader);
    if (next >= kMortonEnd || distance >= kMortonEnd - next) {
      reader.refuse("a voxel outside of any map");
      break;
    }
    const octomap::OcTreeKey key = key_of_morton(next + distance);
    keys.insert(keys.end(), {key[0], key[1], key[2]});
    next += distance + 1;
  }
  return keys;
}

/// All lowest bytes, then the next ones.
template <class Value>
void put_planes(ByteWriter& writer, const std::vector<Value>& values) {
  static_assert(std::endian::native == std::endian::little);
  for (std::size_t plane = 0; plane < sizeof(Value); ++plane)
    for (const Value& value : values)
      writer.put(std::bit_cast<std::array<std::uint8_t, sizeof(Value)>>(value)[plane]);
}

template <class Value>
std::vector<Value> get_planes(ByteReader& reader, std::size_t count) {
  std::vector<std::array<std::uint8_t, sizeof(Value)>> raw(reader.ok() ? count : 0);
  for (std::size_t plane = 0; plane < sizeof(Value); ++plane) {
    const auto bytes = reader.get_bytes(count);
    for (std::size_t i = 0; i < bytes.size(); ++i) raw[i][plane] = bytes[i];
  }
  std::vector<Value> values(raw.size());
  std::ranges::transform(raw, values.begin(), [](const auto& v) { return std::bit_cast<Value>(v); });
  return values;
}

void put_head(ByteWriter& writer, const MapUpdate& update) {
  const MapDelta& delta = update.delta;
  for (const std::uint64_t number :
       {delta.map_epoch, delta.map_id, delta.base_revision, delta.revision, delta.keyframe_id})
    writer.put(number);
  writer.put(delta.stamp_ns);
  writer.put(delta.resolution);
  writer.put_count(update.labels.size());
  for (const std::string& label : update.labels) writer.put_text(label);
}

void get_head(ByteReader& reader, MapUpdate& update) {
  MapDelta& delta = update.delta;
  for (std::uint64_t* number :
       {&delta.map_epoch, &delta.map_id, &delta.base_revision, &delta.revision, &delta.keyframe_id})
    *number = reader.get<std::uint64_t>();
  delta.stamp_ns = reader.get<std::int64_t>();
  delta.resolution = reader.get<double>();
  const std::size_t labels = reader.get_count(sizeof(std::uint64_t));
  if (labels > LabelTable::kMaxLabels) reader.refuse("too many labels");
  for (std::size_t i = 0; i < labels && reader.ok(); ++i) update.labels.push_back(reader.get_text());
}

Bytes compressed(const Bytes& raw) {
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), ZSTD_freeCCtx);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kLevel);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  Bytes frame(ZSTD_compressBound(raw.size()));
  const std::size_t size =
      ZSTD_compress2(context.get(), frame.data(), frame.size(), raw.data(), raw.size());
  if (ZSTD_isError(size) != 0) throw std::runtime_error(ZSTD_getErrorName(size));
  frame.resize(size);
  frame.shrink_to_fit();
  return frame;
}

tl::expected<Bytes, std::string> decompressed(std::span<const std::uint8_t> frame) {
  const unsigned long long size = ZSTD_getFrameContentSize(frame.data(), frame.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN)
    return tl::unexpected(std::string("no zstd frame that says its size"));
  if (size > kFreeBytes + kBytesPerByte * frame.size())
    return tl::unexpected(std::string("a frame that says that it is larger than any update"));
  Bytes raw(size);
  if (ZSTD_decompress(raw.data(), raw.size(), frame.data(), frame.size()) != size)
    return tl::unexpected(std::string("a damaged zstd frame"));
  return raw;
}

}  // namespace

Bytes pack(const MapUpdate& update) {
  const MapDelta& delta = update.delta;
  const std::size_t voxels = delta.log_odds.size();
  if (delta.keys.size() != 3 * voxels || delta.labels.size() != voxels || delta.colors.size() != 3 * voxels ||
      delta.deleted_keys.size() % 3 != 0)
    throw std::invalid_argument("an update's arrays do not fit each other");
  ByteWriter writer;
  put_head(writer, update);
  writer.put_count(delta.deleted_keys.size() / 3);
  put_keys(writer, delta.deleted_keys);
  writer.put_count(voxels);
  put_keys(writer, delta.keys);
  put_planes(writer, delta.log_odds);
  put_planes(writer, delta.labels);
  writer.put_bytes(delta.colors);
  return compressed(writer.take());
}

tl::expected<MapUpdate, std::string> unpack_update(std::span<const std::uint8_t> bytes) {
  const auto raw = decompressed(bytes);
  if (!raw) return tl::unexpected(raw.error());
  ByteReader reader(*raw);
  MapUpdate update;
  MapDelta& delta = update.delta;
  get_head(reader, update);
  delta.deleted_keys = get_keys(reader, reader.get_count(1));
  const std::size_t voxels = reader.get_count(kMinVoxelBytes);
  delta.keys = get_keys(reader, voxels);
  delta.log_odds = get_planes<float>(reader, voxels);
  delta.labels = get_planes<std::uint16_t>(reader, voxels);
  const auto colors = reader.get_bytes(3 * voxels);
  delta.colors.assign(colors.begin(), colors.end());
  if (auto read = reader.finish(); !read) return tl::unexpected(read.error());
  return update;
}

}  // namespace rds::mapper
