// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <memory_resource>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "common/concurrency/mailbox.hpp"
#include "common/concurrency/priority.hpp"
#include "common/store/scratch_memory.hpp"
#include "services/tracker/core/tracker.hpp"

namespace rds::tracker {

/// Moves the pictures of keyframes, .4 MB each, to a temporary file, on a thread of its own: of the whole map's
/// only those that were used since the last kRestEvery keyframes are in RAM. Where the disk is full they stay
/// in RAM.
class KeyframePictures {
 public:
  struct Moved {
    KeyframeId keyframe = kNoId;
    Picture before;
    Picture now;
  };

  explicit KeyframePictures(int nice)
      : nice_(nice),
        pictures_(mailbox_, kMost),
        moved_(mailbox_, kMost),
        thread_([this](const std::stop_token& stop) { run(stop); }) {}

  void move(KeyframeId keyframe, Picture picture) { pictures_.push({keyframe, std::move(picture), nullptr}); }
  std::optional<Moved> try_pop() { return moved_.try_pop(); }

 private:
  static constexpr int kRestEvery = 25;
  static constexpr std::size_t kMost = 1000;  // those beyond stay in RAM

  struct Kept {
    std::shared_ptr<store::ScratchMemory> memory;
    std::pmr::vector<std::uint8_t> pixels;
    ImagePyramid picture;  // of these
  };

  void run(const std::stop_token& stop) {
    concurrency::give_way(nice_);
    bool has_warned = false;
    for (int count = 1; mailbox_.wait(stop, [this] { return !pictures_.locked_empty(); });) {
      auto picture = pictures_.try_pop();
      if (!picture) continue;
      picture->now = copied(*picture->before);
      moved_.push(std::move(*picture));
      if (count++ % kRestEvery == 0) memory_->rest();
      if (memory_->bytes_in_ram() > 0 && !std::exchange(has_warned, true))
        spdlog::warn("no room for a temporary file (TMPDIR): keyframes' pictures stay in memory");
    }
  }

  [[nodiscard]] Picture copied(const ImagePyramid& picture) const {
    std::pmr::vector<std::uint8_t> pixels(picture.bytes(), memory_.get());
    ImagePyramid copy = picture.copied_to(pixels.data());
    const auto kept = std::make_shared<const Kept>(memory_, std::move(pixels), std::move(copy));
    return {kept, &kept->picture};
  }

  int nice_;
  std::shared_ptr<store::ScratchMemory> memory_ = std::make_shared<store::ScratchMemory>();
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<Moved> pictures_;
  concurrency::Inbox<Moved> moved_;
  std::jthread thread_;  // last: it uses the members above
};

}  // namespace rds::tracker
