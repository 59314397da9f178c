// SPDX-License-Identifier: Apache-2.0
#include "common/mcap/compression.hpp"

#include <algorithm>
#include <memory>
#include <new>
#include <utility>

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

namespace rds::mcap {
namespace {

constexpr int kZstdLevel = 1;  // a recorder has to keep up with its topics
constexpr std::array<std::pair<Compression, std::string_view>, 3> kNames{
    {{Compression::kNone, ""}, {Compression::kLz4, "lz4"}, {Compression::kZstd, "zstd"}}};

/// Makes room; memory that was used before is not written again.
void grow(Bytes& buffer, std::size_t size) {
  if (buffer.size() < size) buffer.resize(size);
}

View compress_lz4(View records, Bytes& buffer) {
  LZ4F_preferences_t preferences = LZ4F_INIT_PREFERENCES;
  preferences.frameInfo.blockSizeID = LZ4F_max256KB;
  preferences.frameInfo.contentSize = records.size();
  grow(buffer, LZ4F_compressFrameBound(records.size(), &preferences));
  const std::size_t size =
      LZ4F_compressFrame(buffer.data(), buffer.size(), records.data(), records.size(), &preferences);
  if (LZ4F_isError(size) != 0) throw std::bad_alloc();  // nothing else can fail with room enough
  return View(buffer).first(size);
}

View compress_zstd(View records, Bytes& buffer) {
  grow(buffer, ZSTD_compressBound(records.size()));
  const std::size_t size =
      ZSTD_compress(buffer.data(), buffer.size(), records.data(), records.size(), kZstdLevel);
  if (ZSTD_isError(size) != 0) throw std::bad_alloc();
  return View(buffer).first(size);
}

/// One step of a decompressor: it takes from `in`, puts into `out`, and says how it stands.
struct Step {
  std::size_t taken = 0;
  std::size_t put = 0;
  bool ended = false;  // the frame is complete
  bool failed = false;
};

/// Drives a decompressor over all of `compressed`, into memory that grows as it is filled.
template <class TakeStep>
tl::expected<Bytes, std::string> drive(View compressed, std::size_t size, TakeStep take_step) {
  constexpr std::size_t kFirstBytes = 64 * 1024;
  Bytes out(std::min(size, 4 * compressed.size() + kFirstBytes));
  std::size_t filled = 0;
  Step step;
  while (!step.ended) {
    if (filled == out.size() && out.size() < size) out.resize(std::min(size, 2 * out.size()));
    step = take_step(compressed, std::span(out).subspan(filled));
    compressed = compressed.subspan(step.taken);
    filled += step.put;
    const bool stuck =
        step.taken == 0 && step.put == 0 && !step.ended && (filled < out.size() || out.size() == size);
    if (step.failed || stuck)
      return tl::unexpected<std::string>("compressed records that are torn or foreign");
  }
  if (filled != size || !compressed.empty())
    return tl::unexpected<std::string>("compressed records of another size than announced");
  out.resize(filled);
  return out;
}

struct FreeLz4 {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};
struct FreeZstd {
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

tl::expected<Bytes, std::string> decompress_lz4(View compressed, std::size_t size) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, FreeLz4> context(made);
  return drive(compressed, size, [&](View in, std::span<std::uint8_t> out) {
    std::size_t taken = in.size();
    std::size_t put = out.size();
    const std::size_t hint = LZ4F_decompress(context.get(), out.data(), &put, in.data(), &taken, nullptr);
    return Step{taken, put, hint == 0, LZ4F_isError(hint) != 0};
  });
}

tl::expected<Bytes, std::string> decompress_zstd(View compressed, std::size_t size) {
  const std::unique_ptr<ZSTD_DCtx, FreeZstd> context(ZSTD_createDCtx());
  if (!context) throw std::bad_alloc();
  return drive(compressed, size, [&](View in, std::span<std::uint8_t> out) {
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    ZSTD_outBuffer output{out.data(), out.size(), 0};
    const std::size_t hint = ZSTD_decompressStream(context.get(), &output, &input);
    return Step{input.pos, output.pos, hint == 0, ZSTD_isError(hint) != 0};
  });
}

}  // namespace

std::string name_of(Compression compression) {
  return std::string(kNames[static_cast<std::size_t>(compression)].second);
}

std::optional<Compression> compression_from_name(std::string_view name) {
  for (const auto& [compression, known] : kNames)
    if (known == name) return compression;
  return std::nullopt;
}

View compress(View records, Compression compression, Bytes& buffer) {
  switch (compression) {
    case Compression::kLz4:
      return compress_lz4(records, buffer);
    case Compression::kZstd:
      return compress_zstd(records, buffer);
    case Compression::kNone:
      break;
  }
  return records;
}

tl::expected<Bytes, std::string> decompress(View compressed, Compression compression, std::size_t size) {
  if (compression == Compression::kLz4) return decompress_lz4(compressed, size);
  if (compression == Compression::kZstd) return decompress_zstd(compressed, size);
  if (compressed.size() != size) return tl::unexpected<std::string>("records of another size than announced");
  return Bytes(compressed.begin(), compressed.end());
}

std::uint32_t crc32_of(View bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, bytes.data(), bytes.size()));
}

}  // namespace rds::mcap
