// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "common/image/recording.hpp"

namespace rds::doctor {

/// What the lists of a recording say, without its pictures. Stamps increase [ns].
struct RecordingLists {
  std::size_t depth_pictures = 0;
  std::size_t repeated = 0;               // lines whose stamp equals the one before
  std::vector<std::int64_t> frames;       // colour pictures
  std::vector<std::int64_t> depth_after;  // how much later depth was taken [ns], of the frames that have it
  std::optional<std::vector<std::int64_t>> truth;
  std::vector<std::filesystem::path> missing;  // pictures that are listed but not there
};

RecordingLists lists_of(const image::Recording& dataset);

}  // namespace rds::doctor
