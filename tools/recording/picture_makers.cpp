// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/picture_makers.hpp"

#include <fmt/format.h>

namespace rds::recording {

tl::expected<PictureMakers, std::string> picture_makers(const RecordedCamera& color,
                                                        const RecordedCamera& depth,
                                                        const RobotTopics& robot) {
  image::PictureRegistration registration([&](const std::string& target, const std::string& source,
                                              std::int64_t) { return robot.look_up(target, source); });
  registration.set_color_lens(color.lens.value(), color.frame);
  if (depth.lens) registration.set_depth_lens(*depth.lens);
  PictureMakers makers;
  std::string depth_frame = depth.frame;
  const bool is_elsewhere = !depth_frame.empty() && !color.frame.empty() && depth_frame != color.frame;
  if (is_elsewhere && depth.size == color.size && !robot.look_up(color.frame, depth_frame)) {
    makers.note = fmt::format("taken as registered to colour, as no tf joins its frame '{}' with '{}'",
                              depth_frame, color.frame);
    depth_frame = color.frame;
  }
  auto make_color = registration.color(color.size, color.frame);
  if (!make_color) return tl::unexpected(make_color.error());
  auto make_depth = registration.depth(depth.size, depth_frame, 0);
  if (!make_depth) return tl::unexpected(make_depth.error());
  makers.color = std::move(*make_color);
  makers.depth = std::move(*make_depth);
  if (makers.depth && makers.note.empty() && (is_elsewhere || depth.size != color.size))
    makers.note = fmt::format("of {}×{} px in frame '{}', registered to colour", depth.size.width,
                              depth.size.height, depth.frame);
  return makers;
}

}  // namespace rds::recording
