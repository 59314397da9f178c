// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <tl/expected.hpp>

#include "common/bus/type_ops.hpp"
#include "common/image/recording.hpp"
#include "tools/recording/bag/bag_writer.hpp"

namespace rds::recording {

/// What a conversion did.
struct Converted {
  std::uint64_t items = 0;       // messages, or pictures
  std::uint64_t unreadable = 0;  // pictures that were left out
  std::string fault = {};        // the sentence of the first, or of a torn source
};

/// A topic of a type of ours, with its definition and hash.
BagTopic topic_of(const std::string& name, const bus::TypeOps& type, const std::string& qos);

/// Copies every message of a bag, byte for byte, with its topic's description.
tl::expected<Converted, std::string> copy_bag(Bag& from, BagWriter& to);

/// Writes what a robot would have published of a recording, the camera's pictures and its other sensors with
/// their places in tf_static, and its true path as PoseStamped on /groundtruth; log times are the stamps.
tl::expected<Converted, std::string> write_bag(const image::Recording& recording, BagWriter& to);

/// Writes a folder in TUM form. Colour as PNG; depth of 16 bits as it is, of 32 bits in millimetres; odometry
/// as that of the camera, an IMU in the camera's axes.
/// @param folder  made if it is not there.
tl::expected<Converted, std::string> write_tum_folder(const image::Recording& recording,
                                                      const std::filesystem::path& folder);

}  // namespace rds::recording
