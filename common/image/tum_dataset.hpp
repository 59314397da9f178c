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
#include "common/image/camera_yaml.hpp"
#include "common/image/rgbd_frame.hpp"
#include "common/image/tum_list.hpp"

namespace rds::image {

/// A colour picture and the depth picture that goes with it, if there is one.
struct FrameRef {
  std::size_t index = 0;  // place in rgb.txt
  std::int64_t stamp_ns = 0;
  std::string stamp_text;  // the stamp's digits in rgb.txt; what output files repeat
  std::filesystem::path color_path;
  std::int64_t depth_stamp_ns = 0;   // the colour picture's where there is no depth
  std::filesystem::path depth_path;  // empty where there is none

  [[nodiscard]] bool has_depth() const { return !depth_path.empty(); }
};

struct TumDatasetOptions {
  std::int64_t pairing_tolerance_ns = 20'000'000;  // colour and depth further apart never pair
};

/// A folder in TUM RGB-D form: rgb.txt, depth.txt, optional groundtruth.txt, optional camera.yaml.
///
/// Immutable after open(); load() may be called from several threads.
class TumDataset {
 public:
  /// Reads lists, ground truth and camera, and pairs colour with depth (pair_in_order()); opens no picture. A
  /// colour picture without a partner is a frame without depth.
  ///
  /// @return or one sentence that names the file, the line and what was expected: missing folder or list,
  /// malformed line, stamps that go backwards, colour and depth that never pair, bad camera.yaml, unknown
  /// camera.
  static tl::expected<TumDataset, std::string> open(const std::filesystem::path& folder,
                                                    const TumDatasetOptions& options = {});

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const std::vector<FrameRef>& frames() const { return frames_; }
  [[nodiscard]] const geometry::CameraModel& camera() const { return camera_.camera; }
  [[nodiscard]] double depth_scale() const { return camera_.depth_scale; }  // raw units per metre
  [[nodiscard]] double fps() const { return camera_.fps; }
  [[nodiscard]] const std::optional<std::vector<geometry::StampedPose>>& ground_truth() const {
    return ground_truth_;
  }
  [[nodiscard]] const TumList& color_list() const { return color_; }
  [[nodiscard]] const TumList& depth_list() const { return depth_; }
  /// Frames that no depth picture is near enough to.
  [[nodiscard]] std::size_t without_depth() const;

  /// The digits of a frame's stamp as rgb.txt writes them; format_stamp() for a stamp that is no frame's.
  [[nodiscard]] std::string stamp_text(std::int64_t stamp_ns) const;

  /// Decodes both pictures (16-bit depth with 1/depth_scale metres per unit; all zero for a frame without
  /// depth).
  ///
  /// @return or one sentence that names the picture: missing, truncated, of another size or type.
  [[nodiscard]] tl::expected<RgbdFrame, std::string> load(const FrameRef& frame) const;

 private:
  TumDataset() = default;
  tl::expected<void, std::string> read_camera();
  tl::expected<void, std::string> pair_frames(const TumDatasetOptions& options);

  std::filesystem::path folder_;
  CameraDescription camera_;
  TumList color_;
  TumList depth_;
  std::vector<FrameRef> frames_;
  std::optional<std::vector<geometry::StampedPose>> ground_truth_;
};

}  // namespace rds::image
