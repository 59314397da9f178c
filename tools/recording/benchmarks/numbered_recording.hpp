// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/image/recording.hpp"

namespace rds::recording {

/// Of the camera that has recorded a benchmark.
struct NumberedForm {
  geometry::CameraModel camera;
  double depth_scale = 1000;                               // raw units per metre
  std::uint16_t no_depth = 0;                              // the value that says so, besides 0
  std::optional<geometry::CameraModel> color_camera = {};  // of the colour pictures, if it is not `camera`
};

/// A folder of numbered pictures without stamps, as benchmarks publish them: 30 frames a second are assumed.
class NumberedRecording final : public image::Recording {
 public:
  struct Entry {
    std::uint64_t number;
    std::filesystem::path color;
    std::filesystem::path depth;
  };
  using Truth = std::vector<std::pair<std::uint64_t, geometry::Pose>>;  // number, world from camera

  NumberedRecording(NumberedForm form, std::vector<Entry> entries, const Truth& truth);

  /// Where the colour camera is another one than `camera`, the picture is drawn as `camera` would see it,
  /// both being in one place.
  [[nodiscard]] tl::expected<image::ColorImage, std::string> load_color(std::size_t index) const override;
  [[nodiscard]] tl::expected<image::DepthImage, std::string> load_depth(std::size_t index) const override;

 private:
  NumberedForm form_;
  std::vector<Entry> entries_;
};

/// The whole number that a text is; nullopt for another text.
std::optional<std::uint64_t> number_in(std::string_view text);
/// The number between the start and the ending of a name; nullopt for another name.
std::optional<std::uint64_t> number_in(const std::string& name, std::string_view start,
                                       std::string_view ending);
/// The files of a folder whose names are a start, a number and an ending, by number.
std::vector<std::pair<std::uint64_t, std::filesystem::path>> numbered_files(
    const std::filesystem::path& folder, std::string_view start, std::string_view ending);
/// A 4×4 matrix, row by row, that moves points.
std::optional<geometry::Pose> read_matrix(std::istream& in);

}  // namespace rds::recording
