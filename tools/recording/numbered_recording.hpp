// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "common/image/recording.hpp"

namespace rds::recording {

/// A folder of numbered pictures without stamps, as benchmarks publish them: 30 frames a second are assumed.
class NumberedRecording final : public image::Recording {
 public:
  using Opened = tl::expected<std::unique_ptr<NumberedRecording>, std::string>;

  /// A sequence of Microsoft 7-Scenes: frame-NNNNNN.color.png, .depth.png (mm, 65535: none), .pose.txt.
  static Opened open_seven_scenes(const std::filesystem::path& folder);
  static bool is_seven_scenes(const std::filesystem::path& folder);

  /// A sequence of ICL-NUIM in its TUM-compatible form: associations.txt (`number depth number colour`),
  /// depth in 1/5000 m, poses in a file *.gt.freiburg.
  ///
  /// Its camera looks along z with y up (f_y = −480). Pictures have y down, so with f_y = 480 the world is
  /// mirrored in y, and so are the poses that are read: t_y → −t_y, q_x → −q_x, q_z → −q_z.
  static Opened open_icl_nuim(const std::filesystem::path& folder);
  static bool is_icl_nuim(const std::filesystem::path& folder);

  [[nodiscard]] tl::expected<image::ColorImage, std::string> load_color(std::size_t index) const override;
  [[nodiscard]] tl::expected<image::DepthImage, std::string> load_depth(std::size_t index) const override;

 private:
  struct Entry {
    std::uint64_t number;
    std::filesystem::path color;
    std::filesystem::path depth;
  };
  NumberedRecording(const geometry::CameraModel& camera, double depth_scale, std::uint16_t no_depth);
  void set_entries(std::vector<Entry> entries);

  std::vector<Entry> entries_;
  std::uint16_t no_depth_;  // the value that says so, besides 0
};

}  // namespace rds::recording
