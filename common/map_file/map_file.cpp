// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/map_file.hpp"

#include <fmt/format.h>
#include <openssl/sha.h>

#include "common/map_file/byte_reader.hpp"

namespace rds::map_file {
namespace fs = std::filesystem;
namespace {

// The line end shows a transfer that took the file for text.
constexpr std::array<std::uint8_t, 8> kMagic{'R', 'D', 'S', 'M', 'A', 'P', '\r', '\n'};
using Digest = std::array<std::uint8_t, SHA256_DIGEST_LENGTH>;
constexpr std::size_t kEntryBytes = 16 + SHA256_DIGEST_LENGTH;  // without the name's characters

Digest digest_of(std::span<const std::uint8_t> bytes) {
  Digest digest{};
  SHA256(bytes.data(), bytes.size(), digest.data());
  return digest;
}

struct Entry {
  std::string name;
  std::uint64_t size = 0;
  std::span<const std::uint8_t> digest;
};

bool has_digest(std::span<const std::uint8_t> bytes, std::span<const std::uint8_t> expected) {
  return std::ranges::equal(digest_of(bytes), expected);
}

}  // namespace

Bytes to_bytes(const Sections& sections) {
  ByteWriter writer;
  writer.put_bytes(kMagic);
  writer.put(kFormatVersion);
  writer.put_count(sections.size());
  for (const auto& [name, payload] : sections) {
    writer.put_text(name);
    writer.put_count(payload.size());
    writer.put_bytes(digest_of(payload));
  }
  writer.put_bytes(digest_of(writer.bytes()));
  for (const auto& [name, payload] : sections) writer.put_bytes(payload);
  return writer.take();
}

tl::expected<Sections, std::string> sections_from_bytes(std::span<const std::uint8_t> bytes) {
  const auto refuse = [](std::string why) { return tl::unexpected(std::move(why)); };
  if (bytes.size() < kMagic.size() || !std::ranges::equal(bytes.first(kMagic.size()), kMagic))
    return refuse("is not a saved map, expected a map.rds of rds run");
  ByteReader reader(bytes);
  reader.get_bytes(kMagic.size());
  if (const auto version = reader.get<std::uint32_t>(); reader.ok() && version != kFormatVersion)
    return refuse(fmt::format("has format version {}, expected {}", version, kFormatVersion));
  std::vector<Entry> entries(reader.get_count(kEntryBytes));
  std::size_t header = kMagic.size() + sizeof(kFormatVersion) + sizeof(std::uint64_t);
  std::uint64_t payload = 0;
  for (Entry& entry : entries) {
    entry.name = reader.get_text();
    entry.size = reader.get<std::uint64_t>();
    entry.digest = reader.get_bytes(SHA256_DIGEST_LENGTH);
    header += kEntryBytes + entry.name.size();
  }
  const auto digest = reader.get_bytes(SHA256_DIGEST_LENGTH);
  if (!reader.ok())
    return refuse(fmt::format("is torn: its table of contents needs more than {} bytes", bytes.size()));
  if (!has_digest(bytes.first(header), digest))
    return refuse("is damaged: its table of contents has another checksum");
  for (const Entry& entry : entries) payload += entry.size;
  const std::size_t there = bytes.size() - header - SHA256_DIGEST_LENGTH;
  if (payload != there)
    return refuse(fmt::format("is torn: it has {} bytes of maps, expected {}", there, payload));
  Sections sections;
  for (const Entry& entry : entries) {
    const auto part = reader.get_bytes(entry.size);
    if (!has_digest(part, entry.digest))
      return refuse(fmt::format("is damaged: its section '{}' has another checksum", entry.name));
    sections[entry.name] = Bytes(part.begin(), part.end());
  }
  return sections;
}

tl::expected<Sections, std::string> read_map_file(const fs::path& file, const FileLimits& limits) {
  const auto bytes = read_regular_file(file, limits);
  if (!bytes)
    return tl::unexpected(fmt::format("{}: cannot be read, expected a saved map (map.rds): {}", file.string(),
                                      bytes.error()));
  auto sections = sections_from_bytes(*bytes);
  if (!sections) return tl::unexpected(fmt::format("{}: {}", file.string(), sections.error()));
  return sections;
}

}  // namespace rds::map_file
