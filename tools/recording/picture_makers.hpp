// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <opencv2/core.hpp>
#include <tl/expected.hpp>

#include "common/image/registration/picture_registration.hpp"
#include "tools/recording/robot_topics.hpp"

namespace rds::recording {

/// What a bag says of one of its cameras.
struct RecordedCamera {
  cv::Size size;      // of its pictures
  std::string frame;  // frame_id of their headers
  std::optional<geometry::Lens> lens = {};
};

/// How pictures of a bag become those of its colour camera, without its lens' distortion: safe to be called
/// by several threads. Empty: they stay as they are.
struct PictureMakers {
  image::PictureRegistration::MakeColor color = {};
  image::PictureRegistration::MakeDepth depth = {};
  std::string note = {};  // what the user may want to know, or empty
};

/// As the tracker does it with a driver's pictures. A bag does not change any more: depth of colour's size
/// whose frame no transform joins with colour's is taken as registered, with a note.
/// @param color  with its lens. @return or what is missing.
tl::expected<PictureMakers, std::string> picture_makers(const RecordedCamera& color,
                                                        const RecordedCamera& depth,
                                                        const RobotTopics& robot);

}  // namespace rds::recording
