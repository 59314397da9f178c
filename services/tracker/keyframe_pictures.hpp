// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include <spdlog/spdlog.h>

#include "common/store/scratch_memory.hpp"
#include "services/tracker/core/tracker.hpp"

namespace rds::tracker {

/// Keeps the pictures of keyframes, .4 MB each, in a temporary file: of the whole map's only those that were
/// used since the last kRestEvery keyframes are in RAM. Where the disk is full they stay in RAM.
class KeyframePictures {
 public:
  Picture operator()(Picture picture) {
    if (++kept_ % kRestEvery == 0) memory_->rest();
    auto place = memory_->allocate(picture->bytes());
    if (!place) return in_ram(std::move(picture));
    const auto kept = std::make_shared<const Kept>(picture->copied_to(place.get()), place);
    return {kept, &kept->picture};
  }

 private:
  static constexpr int kRestEvery = 25;

  struct Kept {
    ImagePyramid picture;
    std::shared_ptr<std::uint8_t[]> place;
  };

  Picture in_ram(Picture picture) {
    if (!std::exchange(has_warned_, true))
      spdlog::warn("no room for a temporary file (TMPDIR): keyframes' pictures stay in memory");
    return picture;
  }

  std::shared_ptr<store::ScratchMemory> memory_ = std::make_shared<store::ScratchMemory>();
  int kept_ = 0;
  bool has_warned_ = false;
};

}  // namespace rds::tracker
