// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/association.hpp"

#include <limits>

namespace rds::geometry {
namespace {
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// The last link of a chain of pairs; a longer chain is better, then one with a smaller sum of differences.
struct Chain {
  std::size_t length = 0;
  std::int64_t difference = 0;
  std::size_t link = kNone;

  [[nodiscard]] bool better_than(const Chain& other) const {
    return length != other.length ? length > other.length : difference < other.difference;
  }
};

struct Link {
  std::size_t i;
  std::size_t j;
  std::size_t previous;
};

/// Fenwick tree: the best chain that ends before a given element of b.
class BestChainBefore {
 public:
  explicit BestChainBefore(std::size_t size) : tree_(size + 1) {}

  [[nodiscard]] Chain get(std::size_t j) const {
    Chain best;
    for (; j > 0; j -= j & (~j + 1))
      if (tree_[j].better_than(best)) best = tree_[j];
    return best;
  }

  void put(std::size_t j, const Chain& chain) {
    for (++j; j < tree_.size(); j += j & (~j + 1))
      if (chain.better_than(tree_[j])) tree_[j] = chain;
  }

 private:
  std::vector<Chain> tree_;
};

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> pair_in_order(std::span<const std::int64_t> a,
                                                               std::span<const std::int64_t> b,
                                                               std::int64_t max_difference_ns) {
  BestChainBefore best(b.size());
  std::vector<Link> links;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto first = std::ranges::lower_bound(b, a[i] - max_difference_ns);
    const auto last = std::ranges::upper_bound(b, a[i] + max_difference_ns);
    // From the back, so that a chain with element i is not continued by element i.
    for (auto it = last; it > first;) {
      --it;
      const auto j = static_cast<std::size_t>(it - b.begin());
      const Chain before = best.get(j);
      const std::int64_t difference = *it > a[i] ? *it - a[i] : a[i] - *it;
      best.put(j, {before.length + 1, before.difference + difference, links.size()});
      links.push_back({i, j, before.link});
    }
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t link = best.get(b.size()).link; link != kNone; link = links[link].previous)
    pairs.emplace_back(links[link].i, links[link].j);
  std::ranges::reverse(pairs);
  return pairs;
}

}  // namespace rds::geometry
