// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <vector>

namespace rds::fuzz {

using Bytes = std::vector<std::uint8_t>;

/// Spoils good bytes; the same seed spoils them in the same ways.
class Mutation {
 public:
  explicit Mutation(std::uint64_t seed) : random_(seed) {}

  /// One of the seeds after one to six changes: bits, bytes, numbers that are easily wrong, parts missing,
  /// twice, or of another seed.
  Bytes of(const std::vector<Bytes>& seeds);

  std::size_t below(std::size_t limit) { return limit == 0 ? 0 : random_() % limit; }

 private:
  void change(Bytes& bytes, const std::vector<Bytes>& seeds);
  void overwrite_number(Bytes& bytes);

  std::mt19937_64 random_;
};

}  // namespace rds::fuzz
