// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "common/image/depth_registration.hpp"
#include "common/image/lens_table.hpp"

namespace rds::image {

/// How the pictures of a camera become those of the one pinhole camera that the tracker knows: colour and its
/// registered depth without the distortion that geometry::CameraModel does not have, other depth registered
/// to colour.
///
/// Says how; who asks does it, outside of any lock.
///
/// Depth of colour's size and frame is taken as registered. Depth of another size in the same frame is
/// resampled by the depth camera's own camera_info, as a pixel's place does not depend on its depth there.
/// Depth in a frame that stands elsewhere is registered measurement by measurement, by that camera_info and
/// tf.
class PictureRegistration {
 public:
  /// Empty: the picture stays as it is.
  using MakeColor = std::function<ColorImage(const ColorImage&)>;
  using MakeDepth = std::function<DepthImage(const DepthImage&)>;
  /// @return target_from_source by tf; nullopt if no path joins the frames.
  using LookUp = std::function<std::optional<geometry::Pose>(
      const std::string& target, const std::string& source, std::int64_t stamp_ns)>;

  explicit PictureRegistration(LookUp look_up) : look_up_(std::move(look_up)) {}

  /// @param frame_id  of its header: colour's as long as no picture has come.
  void set_color_lens(const geometry::Lens& lens, const std::string& frame_id);
  void set_depth_lens(const geometry::Lens& lens) { depth_lens_ = lens; }

  /// Before the lens is known, a picture stays as it is.
  /// @param frame_id  of its header. @return or what is wrong, and what to do about it.
  tl::expected<MakeColor, std::string> color(const cv::Size& size, const std::string& frame_id);
  tl::expected<MakeDepth, std::string> depth(const cv::Size& size, const std::string& frame_id,
                                             std::int64_t stamp_ns);

  [[nodiscard]] bool knows_lens() const { return color_lens_.has_value(); }
  /// Whether pictures that came before the lens may be used as they are, as far as is known.
  [[nodiscard]] bool leaves_early_pictures() const;
  /// Of the last picture, before the first of camera_info; empty before both.
  [[nodiscard]] const std::string& color_frame() const;

 private:
  using Table = std::shared_ptr<const LensTable>;

  [[nodiscard]] bool is_of_another_frame(const std::string& depth_frame) const;
  tl::expected<MakeDepth, std::string> depth_elsewhere(const cv::Size& size,
                                                       const geometry::Pose& color_from_depth);
  [[nodiscard]] std::string fault_of_depth_lens(const cv::Size& size) const;

  LookUp look_up_;
  std::optional<geometry::Lens> color_lens_;
  std::optional<geometry::Lens> depth_lens_;
  std::string info_frame_;  // of colour's camera_info
  std::string color_frame_;
  std::string depth_frame_;
  Table color_table_;  // colour's lens to the camera
  Table depth_table_;  // depth's lens to the camera, of the same frame
  std::shared_ptr<const DepthRegistration> elsewhere_;
};

}  // namespace rds::image
