// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "services/tracker/core/triangulation/search_view.hpp"

namespace rds::tracker {

/// The free feature of a view that lies on the epipolar line of another one's (1.96 σ) and looks like it, if
/// no other corner there does; before both cameras, at distances that the features' levels explain.
/// @param into  with its free features listed.
std::optional<std::uint32_t> find_along_line(const ScalePyramid& pyramid, const SearchView& from,
                                             const FreeFeature& f, const SearchView& into);

}  // namespace rds::tracker
