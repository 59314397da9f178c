// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <octomap/ColorOcTree.h>
#include <tl/expected.hpp>

namespace rds::mapper {

/// The tree and the label table of a saved map, of any resolution; objects and votes are not read.
struct SavedTree {
  std::unique_ptr<octomap::ColorOcTree> tree;
  std::vector<std::string> labels;  // index 0 is ""
};

/// Reads both from the mapper's part of a saved map, as to_bytes() gives it.
/// @return or one sentence saying what is wrong with the bytes.
tl::expected<SavedTree, std::string> tree_from_map_bytes(std::span<const std::uint8_t> bytes);

}  // namespace rds::mapper
