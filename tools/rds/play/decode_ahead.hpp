// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include <tl/expected.hpp>

#include "common/image/recording.hpp"

namespace rds::play {

/// Decodes frames [first, last) of a recording, over and over if `loop`, a few frames ahead of the reader.
class DecodeAhead {
 public:
  struct Decoded {
    std::size_t index;  // in the dataset
    std::size_t pass;   // 0 for the first
    tl::expected<image::RgbdFrame, std::string> frame;
  };

  DecodeAhead(const image::Recording& dataset, std::size_t first, std::size_t last, bool loop);

  /// The next frame in order; nullopt at the end, or when stop is requested.
  std::optional<Decoded> next(const std::stop_token& stop);

 private:
  static constexpr std::size_t kAhead = 4;
  void decode(const std::stop_token& stop, std::size_t first, std::size_t last, bool loop);
  bool push(const std::stop_token& stop, Decoded decoded);

  const image::Recording& dataset_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Decoded> decoded_;
  bool finished_ = false;
  std::jthread thread_;  // last: it uses the members above
};

}  // namespace rds::play
