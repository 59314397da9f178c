// SPDX-License-Identifier: Apache-2.0
#include "common/image/registration/picture_registration.hpp"

#include <utility>

#include <fmt/format.h>

namespace rds::image {
namespace {

std::string text_of(const cv::Size& size) {
  return fmt::format("{}×{}", size.width, size.height);
}

cv::Size size_of(const geometry::Lens& lens) {
  return {lens.width, lens.height};
}

constexpr double kSamePlace = 1e-6;  // as tf says identity
constexpr const char* kAlign = "switch the driver's alignment on (align_depth.enable:=true)";

template <class Maker>
std::shared_ptr<const Maker> made(std::shared_ptr<const Maker>& maker, const geometry::Lens& source,
                                  const geometry::CameraModel& target) {
  if (!maker || maker->source() != source || maker->target() != target)
    maker = std::make_shared<const Maker>(source, target);
  return maker;
}

PictureRegistration::MakeDepth by(std::shared_ptr<const LensTable> table) {
  return [table = std::move(table)](const DepthImage& picture) { return table->depth(picture); };
}

}  // namespace

void PictureRegistration::set_color_lens(const geometry::Lens& lens, const std::string& frame_id) {
  color_lens_ = lens;
  info_frame_ = frame_id;
}

const std::string& PictureRegistration::color_frame() const {
  return color_frame_.empty() ? info_frame_ : color_frame_;
}

bool PictureRegistration::leaves_early_pictures() const {
  return !color_lens_ || (color_lens_->is_plain() && !is_of_another_frame(depth_frame_));
}

bool PictureRegistration::is_of_another_frame(const std::string& depth_frame) const {
  return !depth_frame.empty() && !color_frame().empty() && depth_frame != color_frame();
}

tl::expected<PictureRegistration::MakeColor, std::string> PictureRegistration::color(
    const cv::Size& size, const std::string& frame_id) {
  color_frame_ = frame_id;
  if (!color_lens_) return MakeColor();
  if (size != size_of(*color_lens_))
    return tl::unexpected(
        fmt::format("pictures of {} px, but camera_info is of {}: let both come from one driver",
                    text_of(size), text_of(size_of(*color_lens_))));
  if (color_lens_->is_plain()) return MakeColor();
  return [table = made(color_table_, *color_lens_, color_lens_->camera())](const ColorImage& picture) {
    return table->color(picture);
  };
}

tl::expected<PictureRegistration::MakeDepth, std::string> PictureRegistration::depth(
    const cv::Size& size, const std::string& frame_id, std::int64_t stamp_ns) {
  depth_frame_ = frame_id;
  if (!color_lens_) return MakeDepth();
  if (is_of_another_frame(frame_id)) {
    const auto color_from_depth = look_up_(color_frame(), frame_id, stamp_ns);
    if (!color_from_depth)
      return tl::unexpected(fmt::format(
          "depth is in frame '{}', colour in '{}', and no tf joins them, so depth is not registered to "
          "colour: publish tf_static between the two, or {} and set camera.depth to that topic",
          frame_id, color_frame(), kAlign));
    if (!color_from_depth->isApprox(geometry::Pose::Identity(), kSamePlace))
      return depth_elsewhere(size, *color_from_depth);
  }
  if (size == size_of(*color_lens_)) {
    if (color_lens_->is_plain()) return MakeDepth();
    return by(made(color_table_, *color_lens_, color_lens_->camera()));
  }
  if (const std::string fault = fault_of_depth_lens(size); !fault.empty()) return tl::unexpected(fault);
  return by(made(depth_table_, *depth_lens_, color_lens_->camera()));
}

tl::expected<PictureRegistration::MakeDepth, std::string> PictureRegistration::depth_elsewhere(
    const cv::Size& size, const geometry::Pose& color_from_depth) {
  if (const std::string fault = fault_of_depth_lens(size); !fault.empty()) return tl::unexpected(fault);
  return [registration = made(elsewhere_, *depth_lens_, color_lens_->camera()), color_from_depth](
             const DepthImage& picture) { return registration->depth(picture, color_from_depth); };
}

/// Empty if it is of the picture's size.
std::string PictureRegistration::fault_of_depth_lens(const cv::Size& size) const {
  const std::string depth = fmt::format("depth of {} px in frame '{}', colour of {} in '{}'", text_of(size),
                                        depth_frame_, text_of(size_of(*color_lens_)), color_frame());
  if (!depth_lens_)
    return fmt::format("{}: let the driver publish depth's own camera_info (camera.depth_info), or {}", depth,
                       kAlign);
  if (size != size_of(*depth_lens_))
    return fmt::format("{}, but depth's camera_info is of {}: {}", depth, text_of(size_of(*depth_lens_)),
                       kAlign);
  return "";
}

}  // namespace rds::image
