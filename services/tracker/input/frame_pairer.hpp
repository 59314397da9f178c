// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "common/image/rgbd_frame.hpp"
#include "services/tracker/input/depth_offset.hpp"

namespace rds::tracker {

/// Brings colour and depth pictures together by their stamps, whichever of the two streams is ahead.
///
/// Every colour picture makes a frame, in the order of the stamps: with the depth picture nearest to its
/// stamp and DepthOffset within the tolerance, or with an empty one (nothing measured) once none can come any
/// more. That is known when a later depth picture is there, or one from long before, or when too many colour
/// pictures wait for a depth stream that has broken off. Where the stamps of a stream go back, its pictures
/// that still wait are given up.
class FramePairer {
 public:
  using Frames = std::vector<image::RgbdFrame>;

  explicit FramePairer(std::int64_t tolerance_ns) : tolerance_ns_(tolerance_ns) {}

  /// Pictures that wait are given up.
  void forget_waiting();
  /// Pictures wait until the camera is known. @return the frames that were waiting for it.
  Frames set_camera(const geometry::CameraModel& camera);

  /// @return the frames that are complete now. Pictures that are not of the camera's size are given up.
  Frames add_color(std::int64_t stamp_ns, image::ColorImage color);
  Frames add_depth(std::int64_t stamp_ns, image::DepthImage depth);

  /// Pictures given up: depth without colour, colour before the first depth or later than a frame that went
  /// on without it, no camera model that fits.
  [[nodiscard]] std::uint64_t unpaired() const { return unpaired_; }
  /// Frames with an empty depth picture.
  [[nodiscard]] std::uint64_t without_depth() const { return without_depth_; }
  /// Whether the last frame has a depth picture.
  [[nodiscard]] bool last_has_depth() const { return last_has_depth_; }
  /// Between the last colour picture that went on without depth and the depth picture nearest to it; nullopt
  /// where there was none.
  [[nodiscard]] std::optional<std::int64_t> partner_gap_ns() const { return partner_gap_ns_; }
  /// Depth is stamped later than colour by that, as was learned.
  [[nodiscard]] std::int64_t depth_offset_ns() const { return offset_.ns(); }

 private:
  template <class Picture>
  struct Stamped {
    std::int64_t stamp_ns;
    Picture picture;
  };
  using Color = Stamped<image::ColorImage>;
  using Depth = Stamped<image::DepthImage>;

  template <class Picture>
  void put(Stamped<Picture> picture, std::deque<Stamped<Picture>>& waiting);
  Frames take_complete();
  void note_gap(std::int64_t stamp_ns);
  std::optional<Depth> take_partner(std::int64_t stamp_ns);
  [[nodiscard]] bool partner_may_come(std::int64_t stamp_ns) const;
  void make_frame(Color color, std::optional<Depth> depth, Frames& frames);
  template <class Picture>
  void give_up_oldest(std::deque<Stamped<Picture>>& waiting);

  std::int64_t tolerance_ns_;
  DepthOffset offset_;
  std::optional<geometry::CameraModel> camera_;
  std::deque<Color> colors_;
  std::deque<Depth> depths_;
  bool depth_seen_ = false;
  std::optional<std::int64_t> last_stamp_ns_;  // of the last frame
  std::uint64_t unpaired_ = 0;
  std::uint64_t without_depth_ = 0;
  bool last_has_depth_ = false;
  std::optional<std::int64_t> partner_gap_ns_;
};

}  // namespace rds::tracker
