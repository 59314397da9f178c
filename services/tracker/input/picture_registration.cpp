// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/input/picture_registration.hpp"

#include <fmt/format.h>

namespace rds::tracker {
namespace {

std::string text_of(const cv::Size& size) {
  return fmt::format("{}×{}", size.width, size.height);
}

cv::Size size_of(const geometry::Lens& lens) {
  return {lens.width, lens.height};
}

constexpr const char* kAlign = "switch the driver's alignment on (align_depth.enable:=true)";

}  // namespace

tl::expected<PictureRegistration::Table, std::string> PictureRegistration::color(
    const cv::Size& size, const std::string& frame_id) {
  color_frame_ = frame_id;
  if (!color_lens_) return nullptr;
  if (size != size_of(*color_lens_))
    return tl::unexpected(
        fmt::format("pictures of {} px, but camera_info is of {}: let both come from one driver",
                    text_of(size), text_of(size_of(*color_lens_))));
  if (color_lens_->is_plain()) return nullptr;
  return made(color_table_, *color_lens_, color_lens_->camera());
}

tl::expected<PictureRegistration::Table, std::string> PictureRegistration::depth(
    const cv::Size& size, const std::string& frame_id) {
  depth_frame_ = frame_id;
  if (!color_lens_) return nullptr;
  if (size == size_of(*color_lens_)) {
    if (color_lens_->is_plain()) return nullptr;
    return made(color_table_, *color_lens_, color_lens_->camera());
  }
  const std::string sizes =
      fmt::format("depth of {} px, colour of {}", text_of(size), text_of(size_of(*color_lens_)));
  if (!depth_lens_)
    return tl::unexpected(
        fmt::format("{}: let the driver publish depth's own camera_info, or {}", sizes, kAlign));
  if (frame_id != color_frame_)
    return tl::unexpected(
        fmt::format("{}, and in frame '{}', not '{}': {}", sizes, frame_id, color_frame_, kAlign));
  if (size != size_of(*depth_lens_))
    return tl::unexpected(fmt::format("{}, but depth's camera_info is of {}: {}", sizes,
                                      text_of(size_of(*depth_lens_)), kAlign));
  return made(depth_table_, *depth_lens_, color_lens_->camera());
}

PictureRegistration::Table PictureRegistration::made(Table& table, const geometry::Lens& source,
                                                     const geometry::CameraModel& target) {
  if (!table || table->source() != source || table->target() != target)
    table = std::make_shared<const image::LensTable>(source, target);
  return table;
}

}  // namespace rds::tracker
