// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdio>

#include <fmt/format.h>

namespace rds::run {

/// How far a run is: counts the frames and shows them on the terminal, once a second and at the end.
class Progress {
 public:
  explicit Progress(std::size_t frames) : frames_(frames) {}

  void start() { started_ = shown_ = Clock::now(); }

  /// Another frame was played. @param keyframes  of all frames so far.
  void add_frame(std::uint64_t keyframes) {
    ++played_;
    const auto now = Clock::now();
    if (now - shown_ < std::chrono::seconds(1) && played_ < frames_) return;
    shown_ = now;
    fmt::print(stderr, "\rframe {}/{}  {:.1f} frames/s  {} keyframes ", played_, frames_,
               static_cast<double>(played_) / elapsed_s(), keyframes);
    if (played_ == frames_) fmt::print(stderr, "\n");
  }

  [[nodiscard]] std::size_t played() const { return played_; }
  [[nodiscard]] double elapsed_s() const {
    return std::chrono::duration<double>(Clock::now() - started_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::size_t frames_;
  std::size_t played_ = 0;
  Clock::time_point started_;
  Clock::time_point shown_;
};

}  // namespace rds::run
