// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rds::simulator {

/// A large table of standard normal numbers that repeats; each frame reads it from another place.
class NoiseField {
 public:
  /// @param smoothness_px  0 for white noise, else the radius over which neighbours resemble each other.
  NoiseField(std::uint64_t seed, int smoothness_px);

  /// Row `y` of the field of frame and channel `key`, from x = 0 on; valid for kSize − 1 more numbers.
  [[nodiscard]] const float* row(std::uint64_t key, int y) const;

  static constexpr int kSize = 1024;

 private:
  std::vector<float> values_;  // kSize rows of twice kSize columns, so that a row can be read from any start
};

}  // namespace rds::simulator
