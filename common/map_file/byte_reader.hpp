// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

#include <tl/expected.hpp>

namespace rds::map_file {

/// Reads what a ByteWriter wrote, and trusts none of it.
///
/// The first fault stays: from then on every value is 0, every list empty, and finish() says what was wrong.
/// So a reader of a format reads straight through and asks once; only loops over lists end early by
/// themselves.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  /// The next value; a floating-point one must be finite.
  template <class T>
  requires std::is_arithmetic_v<T> T get() {
    std::array<std::uint8_t, sizeof(T)> raw{};
    std::ranges::copy(get_bytes(sizeof(T)), raw.begin());
    if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(raw);
    const T value = std::bit_cast<T>(raw);
    if constexpr (std::is_floating_point_v<T>) {
      if (std::isfinite(value)) return value;
      refuse("a number that is not finite");
      return 0;
    } else {
      return value;
    }
  }

  /// The length of a list; refused where so many elements of `bytes_each` (at least) cannot follow.
  std::size_t get_count(std::size_t bytes_each);
  std::string get_text();
  /// The next bytes, in place; empty after a fault.
  std::span<const std::uint8_t> get_bytes(std::size_t count);

  /// Notes a fault ("keyframe 7 twice"), unless there is one already.
  void refuse(const std::string& fault);
  [[nodiscard]] bool ok() const { return fault_.empty(); }
  [[nodiscard]] bool at_end() const { return left() == 0; }
  /// @return the first fault and its place, or that bytes are left over.
  [[nodiscard]] tl::expected<void, std::string> finish();

 private:
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  std::string fault_;
};

}  // namespace rds::map_file
