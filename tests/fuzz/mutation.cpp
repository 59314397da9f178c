// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/mutation.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace rds::fuzz {
namespace {

constexpr std::size_t kMaxPart = 64;
constexpr std::array<std::uint64_t, 12> kNumbers{0,      1,          0x7f,       0xff,
                                                 0xffff, 0x7fffffff, 0xffffffff, 0x7fffffffffffffff,
                                                 ~0ULL,  0x7f800000, 0x7fc00000, 0x7ff8000000000000};

}  // namespace

Bytes Mutation::of(const std::vector<Bytes>& seeds) {
  Bytes bytes = seeds[below(seeds.size())];
  for (std::size_t changes = 1 + below(6); changes > 0; --changes) change(bytes, seeds);
  return bytes;
}

void Mutation::change(Bytes& bytes, const std::vector<Bytes>& seeds) {
  if (bytes.empty()) return bytes.push_back(static_cast<std::uint8_t>(random_()));
  // Headers and lengths stand at the beginning: half of the changes go there.
  const std::size_t at = below(below(2) == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), kMaxPart));
  const std::size_t part = std::min(1 + below(kMaxPart), bytes.size() - at);
  const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  const auto end = begin + static_cast<std::ptrdiff_t>(part);
  switch (below(8)) {
    case 0:
      bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ 1U << below(8));
      return;
    case 1:
      bytes[at] = static_cast<std::uint8_t>(random_());
      return;
    case 2:
    case 3:
      return overwrite_number(bytes);
    case 4:
      return bytes.resize(at);
    case 5:
      bytes.erase(begin, end);
      return;
    case 6: {
      const Bytes twice(begin, end);
      bytes.insert(begin, twice.begin(), twice.end());
      return;
    }
    default: {
      const Bytes& other = seeds[below(seeds.size())];
      const std::size_t from = below(other.size());
      const std::size_t length = std::min({part, other.size() - from, bytes.size() - at});
      if (length > 0) std::memcpy(&bytes[at], &other[from], length);
    }
  }
}

void Mutation::overwrite_number(Bytes& bytes) {
  const std::size_t size = std::size_t{1} << below(4);
  if (bytes.size() < size) return;
  const std::size_t at = below(below(2) == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), kMaxPart));
  const std::size_t aligned = std::min(at / size * size, bytes.size() - size);
  std::uint64_t number = kNumbers[below(kNumbers.size())];
  if (below(4) == 0) number = random_();
  std::memcpy(&bytes[aligned], &number, size);
}

}  // namespace rds::fuzz
