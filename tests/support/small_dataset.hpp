// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>

namespace rds::test {

/// Writes a dataset of `frames` small random-textured frames (64×48 px, depth 1–3 m in mm, 30 Hz from
/// stamp 10.000000, camera.yaml, ground truth of a straight walk along x at 0.3 m/s). Same arguments, same
/// bytes.
void make_small_dataset(const std::filesystem::path& folder, std::size_t frames);

/// A part of a dataset: frames `start` … `start + frames − 1` of rgb.txt and depth.txt, with links to the
/// pictures; camera.yaml, groundtruth.txt, people.json and masks are linked whole. @throws std::runtime_error
void make_excerpt(const std::filesystem::path& dataset, const std::filesystem::path& destination,
                  std::size_t frames, std::size_t start = 0);

}  // namespace rds::test
