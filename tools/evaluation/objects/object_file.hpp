// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "common/geometry/oriented_box.hpp"

namespace rds::evaluation {

/// A labelled thing, its box upright: its z axis is the direction up.
struct LabelledThing {
  std::string label;
  geometry::OrientedBox box;
};

/// Reads an objects.json, of a run or of a recording; what has gone is left out. A thing without `oriented`
/// has its box along the axes.
/// @return or one sentence that names the file and what was expected.
tl::expected<std::vector<LabelledThing>, std::string> read_things(const std::filesystem::path& file);

}  // namespace rds::evaluation
