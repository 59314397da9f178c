// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include <Eigen/Core>

namespace rds::simulator {

/// One step of the splitmix64 sequence: a good 64-bit hash of a counter (Steele et al., OOPSLA 2014).
inline std::uint64_t hash64(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31U);
}

/// Random numbers that are the same on every machine and with every standard library.
class Random {
 public:
  /// Streams with different numbers are independent: adding a person does not change the room.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0)
      : state_(hash64(seed) ^ hash64(stream * 2654435761U)) {}

  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    return hash64(state_);
  }

  /// [0, 1)
  double uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// 0 … count − 1
  int integer(int count) { return static_cast<int>(uniform() * count); }
  bool chance(double probability) { return uniform() < probability; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }

  /// Standard normal (Box–Muller).
  double normal() {
    const double u = 1.0 - uniform();
    const double v = uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
  }
  Eigen::Vector3d normal_vector() {
    const double x = normal();
    const double y = normal();
    return {x, y, normal()};
  }

 private:
  std::uint64_t state_;
};

}  // namespace rds::simulator
