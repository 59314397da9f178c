// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/play/decode_ahead.hpp"

#include <utility>

#include "common/concurrency/priority.hpp"

namespace rds::play {
namespace {

constexpr int kNice = 10;  // a camera takes no processor time from the services

}  // namespace

DecodeAhead::DecodeAhead(const image::Recording& dataset, std::size_t first, std::size_t last, bool loop)
    : dataset_(dataset),
      thread_([this, first, last, loop](const std::stop_token& stop) { decode(stop, first, last, loop); }) {}

void DecodeAhead::decode(const std::stop_token& stop, std::size_t first, std::size_t last, bool loop) {
  concurrency::give_way(kNice);
  std::size_t pass = 0;
  do {
    for (std::size_t i = first; i < last; ++i)
      if (!push(stop, {i, pass, dataset_.load(dataset_.frames()[i])})) return;
    ++pass;
  } while (loop && first < last);
  const std::lock_guard lock(mutex_);
  finished_ = true;
  changed_.notify_all();
}

bool DecodeAhead::push(const std::stop_token& stop, Decoded decoded) {
  std::unique_lock lock(mutex_);
  if (!changed_.wait(lock, stop, [this] { return decoded_.size() < kAhead; })) return false;
  decoded_.push_back(std::move(decoded));
  changed_.notify_all();
  return true;
}

std::optional<DecodeAhead::Decoded> DecodeAhead::next(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  if (!changed_.wait(lock, stop, [this] { return !decoded_.empty() || finished_; }) || decoded_.empty())
    return std::nullopt;
  Decoded front = std::move(decoded_.front());
  decoded_.pop_front();
  changed_.notify_all();
  return front;
}

}  // namespace rds::play
