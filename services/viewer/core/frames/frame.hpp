// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "common/map_file/byte_writer.hpp"

/// What the page is sent, one binary WebSocket message a frame. FRAMES.md says every byte of it.
namespace rds::viewer {

using Bytes = map_file::Bytes;
using SharedBytes = std::shared_ptr<const Bytes>;

inline constexpr std::uint8_t kFrameVersion = 1;
inline constexpr std::size_t kFrameHeaderBytes = 8;

/// What a frame tells.
enum class Kind : std::uint8_t {
  kHello = 1,      // JSON
  kMap = 2,        // chunks of voxels
  kTracking = 3,   // JSON, each frame of the camera
  kPath = 4,       // where the camera was
  kKeyframes = 5,  // poses, loops
  kBoxes = 6,      // JSON, predicted boxes
  kObjects = 7,    // JSON
  kGrid = 8,       // 2-D
  kPicture = 9,    // JPEG and features
  kServices = 10,  // JSON, figures of each service
  kReply = 11,     // JSON, a service's answer to a command
  kLabels = 12,    // JSON
  kCamera = 13,    // JSON, intrinsics
  kSubmap = 14,    // poses of keyframes that have no place in the map
};
inline constexpr std::size_t kKinds = 15;  // with the 0 that none has

/// The header, to which the payload is appended.
inline map_file::ByteWriter begin_frame(Kind kind) {
  map_file::ByteWriter frame;
  frame.put(std::uint8_t{'R'});
  frame.put(std::uint8_t{'V'});
  frame.put(kFrameVersion);
  frame.put(static_cast<std::uint8_t>(kind));
  frame.put(std::uint32_t{0});
  return frame;
}

/// A frame whose payload is text.
inline Bytes text_frame(Kind kind, std::string_view text) {
  auto frame = begin_frame(kind);
  frame.put_bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return frame.take();
}

}  // namespace rds::viewer
