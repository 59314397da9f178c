// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/input/frame_pairer.hpp"

#include <algorithm>
#include <cstdlib>

#include "common/time/stamp_step.hpp"

namespace rds::tracker {
namespace {
using time::StampStep;

constexpr std::size_t kMaxWaiting = 5;  // as the topics keep
}  // namespace

void FramePairer::forget_waiting() {
  unpaired_ += colors_.size() + depths_.size();
  colors_.clear();
  depths_.clear();
}

FramePairer::Frames FramePairer::set_camera(const geometry::CameraModel& camera) {
  camera_ = camera;
  return take_complete();
}

FramePairer::Frames FramePairer::add_color(std::int64_t stamp_ns, image::ColorImage color) {
  put({stamp_ns, std::move(color)}, colors_);
  return take_complete();
}

FramePairer::Frames FramePairer::add_depth(std::int64_t stamp_ns, image::DepthImage depth) {
  depth_seen_ = true;
  put({stamp_ns, std::move(depth)}, depths_);
  return take_complete();
}

template <class Picture>
void FramePairer::put(Stamped<Picture> picture, std::deque<Stamped<Picture>>& waiting) {
  if (!waiting.empty() && time::step_between(waiting.back().stamp_ns, picture.stamp_ns) == StampStep::kBack) {
    unpaired_ += waiting.size();
    waiting.clear();
  }
  waiting.push_back(std::move(picture));
}

FramePairer::Frames FramePairer::take_complete() {
  Frames frames;
  while (camera_ && !colors_.empty()) {
    const std::int64_t stamp_ns = colors_.front().stamp_ns;
    auto depth = take_partner(stamp_ns);
    if (!depth && partner_may_come(stamp_ns)) break;
    if (!depth) note_gap(stamp_ns);
    Color color = std::move(colors_.front());
    colors_.pop_front();
    make_frame(std::move(color), std::move(depth), frames);
  }
  give_up_oldest(colors_);
  give_up_oldest(depths_);
  return frames;
}

/// The depth picture nearest to where it is expected, within the tolerance; older ones are given up.
std::optional<FramePairer::Depth> FramePairer::take_partner(std::int64_t stamp_ns) {
  const std::int64_t expected_ns = stamp_ns + offset_.ns();
  const auto distance = [&](const Depth& d) { return std::abs(d.stamp_ns - expected_ns); };
  const auto best = std::ranges::min_element(depths_, {}, distance);
  if (best == depths_.end() || distance(*best) > tolerance_ns_) return std::nullopt;
  Depth partner = std::move(*best);
  depths_.erase(best);
  unpaired_ += std::erase_if(depths_, [&](const Depth& d) { return d.stamp_ns <= partner.stamp_ns; });
  offset_.take(partner.stamp_ns - stamp_ns, true);
  return partner;
}

void FramePairer::note_gap(std::int64_t stamp_ns) {
  partner_gap_ns_.reset();
  const auto gap_ns = [&](const Depth& d) { return std::abs(d.stamp_ns - stamp_ns); };
  const auto nearest = std::ranges::min_element(depths_, {}, gap_ns);
  if (nearest == depths_.end()) return;
  partner_gap_ns_ = gap_ns(*nearest);
  offset_.take(nearest->stamp_ns - stamp_ns, false);
}

bool FramePairer::partner_may_come(std::int64_t stamp_ns) const {
  const bool too_late =
      !depths_.empty() && (depths_.back().stamp_ns > stamp_ns + offset_.ns() + tolerance_ns_ ||
                           time::step_between(depths_.back().stamp_ns, stamp_ns) == StampStep::kAhead);
  const bool broken_off = depth_seen_ && colors_.size() > kMaxWaiting;
  return !too_late && !broken_off;
}

void FramePairer::make_frame(Color color, std::optional<Depth> depth, Frames& frames) {
  const cv::Size size(camera_->width, camera_->height);
  const bool fits = color.picture.pixels.size() == size && (!depth || depth->picture.values.size() == size);
  const bool in_order =
      depth || !last_stamp_ns_ || time::step_between(*last_stamp_ns_, color.stamp_ns) != StampStep::kLate;
  if (!fits || !in_order) {
    unpaired_ += depth ? 2 : 1;
    return;
  }
  last_stamp_ns_ = color.stamp_ns;
  if (!depth) ++without_depth_;
  last_has_depth_ = depth.has_value();
  frames.push_back({color.stamp_ns, std::move(color.picture),
                    depth ? std::move(depth->picture) : image::empty_depth(size), *camera_});
}

template <class Picture>
void FramePairer::give_up_oldest(std::deque<Stamped<Picture>>& waiting) {
  for (; waiting.size() > kMaxWaiting; ++unpaired_) waiting.pop_front();
}

}  // namespace rds::tracker
