// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/frame_pairer.hpp"

#include <algorithm>
#include <cstdlib>

namespace rds::tracker {
namespace {
constexpr std::size_t kMaxWaiting = 5;
}

template <class Picture>
auto FramePairer::nearest(std::deque<Stamped<Picture>>& waiting, std::int64_t stamp_ns) const {
  const auto best = std::min_element(waiting.begin(), waiting.end(), [&](const auto& a, const auto& b) {
    return std::abs(a.stamp_ns - stamp_ns) < std::abs(b.stamp_ns - stamp_ns);
  });
  return best != waiting.end() && std::abs(best->stamp_ns - stamp_ns) <= tolerance_ns_ ? best : waiting.end();
}

template <class Picture>
void FramePairer::drop_until(std::deque<Stamped<Picture>>& waiting, std::int64_t stamp_ns) {
  unpaired_ += static_cast<std::uint64_t>(
      std::erase_if(waiting, [&](const auto& picture) { return picture.stamp_ns <= stamp_ns; }));
}

template <class Picture>
void FramePairer::keep(std::deque<Stamped<Picture>>& waiting, Stamped<Picture> picture) {
  waiting.push_back(std::move(picture));
  if (waiting.size() <= kMaxWaiting) return;
  waiting.pop_front();
  ++unpaired_;
}

std::optional<image::RgbdFrame> FramePairer::set_camera(const geometry::CameraModel& camera) {
  const bool first = !camera_;
  camera_ = camera;
  if (!first || colors_.empty()) return std::nullopt;
  Stamped<image::ColorImage> newest = std::move(colors_.back());
  colors_.pop_back();
  return add_color(newest.stamp_ns, std::move(newest.picture));
}

std::optional<image::RgbdFrame> FramePairer::add_color(std::int64_t stamp_ns, image::ColorImage color) {
  const auto partner = nearest(depths_, stamp_ns);
  if (!camera_ || partner == depths_.end()) {
    keep(colors_, {stamp_ns, std::move(color)});
    return std::nullopt;
  }
  auto depth = std::move(*partner);
  depths_.erase(partner);
  return pair({stamp_ns, std::move(color)}, std::move(depth));
}

std::optional<image::RgbdFrame> FramePairer::add_depth(std::int64_t stamp_ns, image::DepthImage depth) {
  const auto partner = nearest(colors_, stamp_ns);
  if (!camera_ || partner == colors_.end()) {
    keep(depths_, {stamp_ns, std::move(depth)});
    return std::nullopt;
  }
  auto color = std::move(*partner);
  colors_.erase(partner);
  return pair(std::move(color), {stamp_ns, std::move(depth)});
}

std::optional<image::RgbdFrame> FramePairer::pair(Stamped<image::ColorImage> color,
                                                  Stamped<image::DepthImage> depth) {
  drop_until(colors_, color.stamp_ns);
  drop_until(depths_, depth.stamp_ns);
  const cv::Size size = color.picture.pixels.size();
  if (size != cv::Size(camera_->width, camera_->height) || size != depth.picture.values.size()) {
    unpaired_ += 2;
    return std::nullopt;
  }
  return image::RgbdFrame{color.stamp_ns, std::move(color.picture), std::move(depth.picture), *camera_};
}

}  // namespace rds::tracker
