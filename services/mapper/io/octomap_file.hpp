// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <octomap/ColorOcTree.h>
#include <tl/expected.hpp>

namespace rds::mapper {

/// Reads the bytes of OctoMap's .ot files (ColorOcTree) and .bt files (any tree: occupied or free), checked
/// as tree_from_bytes() does.
/// @return or what is wrong, in words that can follow "map.ot: ".
tl::expected<std::unique_ptr<octomap::ColorOcTree>, std::string> tree_from_octomap_file(
    std::span<const std::uint8_t> content);

/// True if the bytes start as .ot or .bt files do; the first kOctomapStartBytes suffice.
bool starts_as_octomap_file(std::string_view content);
/// True if they start as .bt files do, which tell states only.
bool starts_as_binary_octomap_file(std::string_view content);
inline constexpr std::size_t kOctomapStartBytes = 28;

}  // namespace rds::mapper
