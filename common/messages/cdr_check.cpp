// SPDX-License-Identifier: Apache-2.0
#include "common/messages/cdr_check.hpp"

#include <algorithm>
#include <type_traits>

namespace rds::messages {
namespace {

constexpr std::size_t kEncapsulationSize = 4;
constexpr std::size_t kMaximumPadding = 3;

/// Walks through a CDR body. Offsets count from the first byte after the encapsulation header, as alignment
/// does. Over bytes that are not const it clears the padding that it passes.
template <class Byte>
class Walker {
 public:
  Walker(std::span<Byte> body, bool little_endian) : body_(body), little_endian_(little_endian) {}

  bool walk(const StructLayout& layout) {
    return std::all_of(layout.fields, layout.fields + layout.field_count,
                       [this](const FieldLayout& field) { return walk_field(field); });
  }

  [[nodiscard]] std::size_t remaining() const { return body_.size() - offset_; }

 private:
  bool walk_field(const FieldLayout& field) {
    std::uint32_t count = std::max(field.array_length, 1U);
    if (field.is_sequence && !read_length(count)) return false;
    if (field.is_sequence && field.array_length > 0 && count > field.array_length) return false;
    if (count == 0) return true;
    if (count > remaining() / field.size) return false;
    if (field.kind == FieldKind::kPrimitive) return skip(field.size, std::size_t{count} * field.size);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!walk_element(field)) return false;
    }
    return true;
  }

  bool walk_element(const FieldLayout& field) {
    switch (field.kind) {
      case FieldKind::kStruct:
        return walk(*field.nested);
      case FieldKind::kString:
        return walk_string(field.string_bound);
      case FieldKind::kBoolean:
        return skip(1, 1) && body_[offset_ - 1] <= 1;
      case FieldKind::kPrimitive:
        return skip(field.size, field.size);
    }
    return false;
  }

  /// A length that counts the terminating zero. 0 (no terminator) is what some writers send for an empty
  /// string.
  bool walk_string(std::uint32_t bound) {
    std::uint32_t length = 0;
    if (!read_length(length)) return false;
    if (length == 0) return true;
    if (bound > 0 && length - 1 > bound) return false;
    return skip(1, length) && body_[offset_ - 1] == 0;
  }

  bool read_length(std::uint32_t& length) {
    if (!skip(4, 4)) return false;
    const std::uint8_t* b = body_.data() + offset_ - 4;
    length = little_endian_ ? assemble(b[0], b[1], b[2], b[3]) : assemble(b[3], b[2], b[1], b[0]);
    return true;
  }

  static std::uint32_t assemble(std::uint32_t b0, std::uint32_t b1, std::uint32_t b2, std::uint32_t b3) {
    return b0 | b1 << 8U | b2 << 16U | b3 << 24U;
  }

  /// `alignment` is a power of two.
  bool skip(std::size_t alignment, std::size_t size) {
    const std::size_t padding = (0 - offset_) & (alignment - 1);
    if (padding > remaining() || size > remaining() - padding) return false;
    if constexpr (!std::is_const_v<Byte>) std::ranges::fill(body_.subspan(offset_, padding), std::uint8_t{0});
    offset_ += padding + size;
    return true;
  }

  std::span<Byte> body_;
  bool little_endian_;
  std::size_t offset_ = 0;
};

}  // namespace

bool is_well_formed(std::span<const std::uint8_t> bytes, const StructLayout& layout) {
  if (bytes.size() < kEncapsulationSize || bytes[0] != 0 || bytes[1] > 1) return false;
  Walker walker(bytes.subspan(kEncapsulationSize), bytes[1] == 1);
  return walker.walk(layout) && walker.remaining() <= kMaximumPadding;
}

void clear_padding(std::span<std::uint8_t> bytes, const StructLayout& layout) {
  if (bytes.size() < kEncapsulationSize) return;
  Walker(bytes.subspan(kEncapsulationSize), bytes[1] == 1).walk(layout);
}

}  // namespace rds::messages
