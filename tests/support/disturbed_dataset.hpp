// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>

namespace rds::test {

/// Frames `first` … `first + count − 1` of a recording.
struct FrameRange {
  std::size_t first = 0;
  std::size_t count = 0;
};

enum class Darkened { kColor, kColorAndDepth };

/// A recording with links to another one's pictures, in which the range's pictures show nothing: the light
/// is out, or the camera is covered. @throws std::runtime_error
void make_blacked_out(const std::filesystem::path& dataset, const std::filesystem::path& destination,
                      FrameRange range, Darkened darkened);

/// The same without the range's colour and depth pictures: the camera was elsewhere in between.
/// @throws std::runtime_error
void make_cut(const std::filesystem::path& dataset, const std::filesystem::path& destination,
              FrameRange range);

/// The same up to `until_s` after its start; then what it shows from `again_from_s` to `again_to_s` once
/// more, time going on. @throws std::runtime_error
void make_jump(const std::filesystem::path& dataset, const std::filesystem::path& destination, double until_s,
               double again_from_s, double again_to_s);

/// What it shows in `turn_s` from `from_s` on, forwards and backwards in turn, time going on, for `length_s`.
/// @throws std::runtime_error
void make_to_and_fro(const std::filesystem::path& dataset, const std::filesystem::path& destination,
                     double from_s, double turn_s, double length_s);

}  // namespace rds::test
