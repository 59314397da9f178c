// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include <tl/expected.hpp>

#include "common/geometry/trajectory.hpp"

namespace rds::evaluation {

/// Pairs of keyframes that loops were closed by, compared with the truth.
struct LoopScore {
  std::size_t right = 0;
  std::size_t wrong = 0;  // off by more than 15 cm or 5°
};

/// @param loops  loops.jsonl as `rds run` writes it. Pairs whose stamps the truth does not reach are left
/// out.
/// @return or one sentence that names the file, the line and what was expected.
tl::expected<LoopScore, std::string> score_loops(const std::filesystem::path& loops,
                                                 std::span<const geometry::StampedPose> truth);

}  // namespace rds::evaluation
