// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "common/geometry/trajectory.hpp"
#include "common/image/rgbd_frame.hpp"
#include "common/image/sensors/robot_sensors.hpp"

namespace rds::image {

/// A colour picture and the depth picture that goes with it, if there is one.
struct FrameRef {
  std::size_t index = 0;  // of the colour picture
  std::int64_t stamp_ns = 0;
  std::string stamp_text;           // the stamp's digits as the recording has them; what output files repeat
  std::int64_t depth_stamp_ns = 0;  // the colour picture's where there is no depth
  std::optional<std::size_t> depth = {};  // index of the depth picture

  [[nodiscard]] bool has_depth() const { return depth.has_value(); }
};

/// Colour and depth further apart never pair.
inline constexpr std::int64_t kPairingToleranceNs = 20'000'000;

/// What an RGB-D camera has recorded, in whatever form it lies: two lists of pictures, paired by their
/// stamps, the camera, and perhaps its true path and other sensors of the robot.
///
/// Immutable once it is open; pictures may be loaded by several threads.
class Recording {
 public:
  virtual ~Recording() = default;

  /// One for each colour picture, by stamp.
  [[nodiscard]] const std::vector<FrameRef>& frames() const { return frames_; }
  [[nodiscard]] const std::vector<std::int64_t>& depth_stamps() const { return depth_stamps_; }
  [[nodiscard]] const geometry::CameraModel& camera() const { return camera_; }
  [[nodiscard]] double fps() const { return fps_; }                  // nominal [1/s]
  [[nodiscard]] double depth_scale() const { return depth_scale_; }  // raw units per metre
  /// Pictures left out because their stamp equals that of the one before.
  [[nodiscard]] std::size_t repeated() const { return repeated_; }
  /// Pictures that are listed, but not there.
  [[nodiscard]] virtual std::vector<std::filesystem::path> missing() const { return {}; }
  [[nodiscard]] const std::optional<std::vector<geometry::StampedPose>>& ground_truth() const {
    return ground_truth_;
  }
  /// What the robot has sensed beside it.
  [[nodiscard]] const RobotSensors& sensors() const { return sensors_; }
  /// Frames that no depth picture is near enough to.
  [[nodiscard]] std::size_t without_depth() const;
  /// The digits of a frame's stamp; format_stamp() for a stamp that is no frame's.
  [[nodiscard]] std::string stamp_text(std::int64_t stamp_ns) const;

  /// Both pictures of a frame, of the camera's size; depth all zero for a frame without it.
  /// @return or one sentence that names the picture: missing, truncated, of another size or type.
  [[nodiscard]] tl::expected<RgbdFrame, std::string> load(const FrameRef& frame) const;
  /// One picture. @param index  below frames().size(). @return as load().
  [[nodiscard]] virtual tl::expected<ColorImage, std::string> load_color(std::size_t index) const = 0;
  /// @param index  below depth_stamps().size().
  [[nodiscard]] virtual tl::expected<DepthImage, std::string> load_depth(std::size_t index) const = 0;

 protected:
  Recording() = default;
  Recording(const Recording&) = default;
  Recording(Recording&&) = default;
  Recording& operator=(const Recording&) = default;
  Recording& operator=(Recording&&) = default;

  /// Sets frames() from the colour pictures (index, stamp and text) and pairs them (pair_in_order()).
  /// @param depth_stamps  ascending. @return how many frames have depth.
  std::size_t pair_frames(std::vector<FrameRef> color, std::vector<std::int64_t> depth_stamps,
                          std::int64_t tolerance_ns);

  geometry::CameraModel camera_;
  double fps_ = 30;
  double depth_scale_ = 1000;
  std::size_t repeated_ = 0;
  std::optional<std::vector<geometry::StampedPose>> ground_truth_;
  RobotSensors sensors_;

 private:
  std::vector<FrameRef> frames_;
  std::vector<std::int64_t> depth_stamps_;
};

}  // namespace rds::image
