// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <memory_resource>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "common/store/scratch_memory.hpp"
#include "services/tracker/core/tracker.hpp"

namespace rds::tracker {

/// Keeps the pictures of keyframes, .4 MB each, in a temporary file: of the whole map's only those that were
/// used since the last kRestEvery keyframes are in RAM. Where the disk is full they stay in RAM.
class KeyframePictures {
 public:
  Picture operator()(const Picture& picture) {
    if (++kept_ % kRestEvery == 0) memory_->rest();
    std::pmr::vector<std::uint8_t> pixels(picture->bytes(), memory_.get());
    ImagePyramid copy = picture->copied_to(pixels.data());
    if (memory_->bytes_in_ram() > 0 && !std::exchange(has_warned_, true))
      spdlog::warn("no room for a temporary file (TMPDIR): keyframes' pictures stay in memory");
    const auto kept = std::make_shared<const Kept>(memory_, std::move(pixels), std::move(copy));
    return {kept, &kept->picture};
  }

 private:
  static constexpr int kRestEvery = 25;

  struct Kept {
    std::shared_ptr<store::ScratchMemory> memory;
    std::pmr::vector<std::uint8_t> pixels;
    ImagePyramid picture;  // of these
  };

  std::shared_ptr<store::ScratchMemory> memory_ = std::make_shared<store::ScratchMemory>();
  int kept_ = 0;
  bool has_warned_ = false;
};

}  // namespace rds::tracker
