// SPDX-License-Identifier: Apache-2.0
#include "tests/support/map_reader.hpp"

#include "services/mapper/core/octree/tree_bytes.hpp"

namespace rds::test {

std::vector<std::uint8_t> MapReader::bytes() const {
  std::vector<std::uint8_t> bytes;
  replica_.look([&](const auto& replica, const auto&) { bytes = mapper::to_bytes(replica.tree()); });
  return bytes;
}

std::size_t MapReader::labelled() const {
  std::size_t count = 0;
  replica_.look([&](const auto& replica, const auto&) {
    for (auto leaf = replica.tree().begin_leafs(), end = replica.tree().end_leafs(); leaf != end; ++leaf)
      count += replica.label(leaf.getKey()) != 0 ? 1U : 0U;
  });
  return count;
}

}  // namespace rds::test
