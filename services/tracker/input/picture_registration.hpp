// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "common/image/lens_table.hpp"

namespace rds::tracker {

/// How the pictures of a camera become those of the one pinhole camera that the tracker knows: colour and its
/// registered depth without the distortion that geometry::CameraModel does not have, depth of another size at
/// colour's.
///
/// Says by which table; who asks applies it, outside of any lock.
///
/// Depth of colour's size is taken as registered to it. Depth of another size is registered here by the depth
/// camera's own camera_info, where both are of one frame: then a pixel's place does not depend on its depth.
class PictureRegistration {
 public:
  /// nullptr: the picture stays as it is.
  using Table = std::shared_ptr<const image::LensTable>;

  void set_color_lens(const geometry::Lens& lens) { color_lens_ = lens; }
  void set_depth_lens(const geometry::Lens& lens) { depth_lens_ = lens; }

  /// Before the lens is known, a picture stays as it is.
  /// @param frame_id  of its header. @return or what is wrong, and what to do about it.
  tl::expected<Table, std::string> color(const cv::Size& size, const std::string& frame_id);
  tl::expected<Table, std::string> depth(const cv::Size& size, const std::string& frame_id);

  /// Of the last pictures.
  [[nodiscard]] const std::string& color_frame() const { return color_frame_; }
  [[nodiscard]] const std::string& depth_frame() const { return depth_frame_; }

 private:
  static Table made(Table& table, const geometry::Lens& source, const geometry::CameraModel& target);

  std::optional<geometry::Lens> color_lens_;
  std::optional<geometry::Lens> depth_lens_;
  std::string color_frame_;
  std::string depth_frame_;
  Table color_table_;  // colour's lens to the camera
  Table depth_table_;  // depth's lens to the camera
};

}  // namespace rds::tracker
