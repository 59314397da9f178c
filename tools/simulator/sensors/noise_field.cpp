// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/noise_field.hpp"

#include <algorithm>
#include <cmath>

#include "tools/simulator/rendering/random.hpp"

namespace rds::simulator {
namespace {

constexpr auto kSize = static_cast<std::size_t>(NoiseField::kSize);

/// Two box filters in each direction, wrapping around.
void soften(std::vector<float>& field, int radius) {
  std::vector<float> line(kSize);
  for (int pass = 0; pass < 4; ++pass) {
    const bool horizontal = pass % 2 == 0;
    for (std::size_t i = 0; i < kSize; ++i) {
      const auto at = [&](std::size_t k) -> float& {
        return horizontal ? field[i * kSize + k] : field[k * kSize + i];
      };
      for (std::size_t k = 0; k < kSize; ++k) {
        float sum = 0;
        for (int d = -radius; d <= radius; ++d) sum += at((k + kSize + static_cast<std::size_t>(d)) % kSize);
        line[k] = sum;
      }
      for (std::size_t k = 0; k < kSize; ++k) at(k) = line[k];
    }
  }
  double square = 0;
  for (const float v : field) square += static_cast<double>(v) * static_cast<double>(v);
  const auto scale = static_cast<float>(1 / std::sqrt(square / static_cast<double>(field.size())));
  for (float& v : field) v *= scale;
}

}  // namespace

NoiseField::NoiseField(std::uint64_t seed, int smoothness_px) : values_(2 * kSize * kSize) {
  Random random(seed, 3);
  std::vector<float> field(kSize * kSize);
  for (float& v : field) v = static_cast<float>(random.normal());
  if (smoothness_px > 0) soften(field, smoothness_px);
  for (std::size_t y = 0; y < kSize; ++y)
    for (std::size_t x = 0; x < 2 * kSize; ++x) values_[y * 2 * kSize + x] = field[y * kSize + x % kSize];
}

const float* NoiseField::row(std::uint64_t key, int y) const {
  const std::uint64_t start = hash64(key);
  const auto first_row = static_cast<std::size_t>(start % kSize);
  const auto first_column = static_cast<std::size_t>((start >> 32U) % kSize);
  return &values_[(first_row + static_cast<std::size_t>(y)) % kSize * 2 * kSize + first_column];
}

}  // namespace rds::simulator
