// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/image/rgbd_frame.hpp"

namespace rds::tracker {

/// Brings colour and depth pictures together by their stamps, in whatever order they arrive.
class FramePairer {
 public:
  explicit FramePairer(std::int64_t tolerance_ns) : tolerance_ns_(tolerance_ns) {}

  /// Pictures wait until the camera is known. @return the frame that was waiting for it.
  std::optional<image::RgbdFrame> set_camera(const geometry::CameraModel& camera);

  /// @return the frame that this picture completes. Pictures that are not of the camera's size are given up.
  std::optional<image::RgbdFrame> add_color(std::int64_t stamp_ns, image::ColorImage color);
  std::optional<image::RgbdFrame> add_depth(std::int64_t stamp_ns, image::DepthImage depth);

  /// Pictures given up: no partner came, they were older than a pair that did, or no camera model fits.
  [[nodiscard]] std::uint64_t unpaired() const { return unpaired_; }

 private:
  template <class Picture>
  struct Stamped {
    std::int64_t stamp_ns;
    Picture picture;
  };
  template <class Picture>
  [[nodiscard]] auto nearest(std::deque<Stamped<Picture>>& waiting, std::int64_t stamp_ns) const;
  template <class Picture>
  void drop_until(std::deque<Stamped<Picture>>& waiting, std::int64_t stamp_ns);
  template <class Picture>
  void keep(std::deque<Stamped<Picture>>& waiting, Stamped<Picture> picture);
  std::optional<image::RgbdFrame> pair(Stamped<image::ColorImage> color, Stamped<image::DepthImage> depth);

  std::int64_t tolerance_ns_;
  std::optional<geometry::CameraModel> camera_;
  std::deque<Stamped<image::ColorImage>> colors_;
  std::deque<Stamped<image::DepthImage>> depths_;
  std::uint64_t unpaired_ = 0;
};

}  // namespace rds::tracker
