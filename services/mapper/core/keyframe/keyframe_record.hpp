// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/dynamic_segmentation/depth_grid.hpp"
#include "services/mapper/core/config/mapper_config.hpp"
#include "services/mapper/core/keyframe/keyframe_input.hpp"
#include "services/mapper/core/keyframe/pixel_class.hpp"
#include "services/mapper/core/keyframe/surface_steps.hpp"

namespace rds::mapper {

/// What is made once for a camera: rays (x, y, 1) of its sampled pixels, row by row; the cells in which
/// movable things are looked for, each of one or more sampled pixels; and how far depths of a surface differ.
class SampledRays {
 public:
  SampledRays(const geometry::CameraModel& camera, const SamplingConfig& config);

  const Eigen::Vector3f& operator[](std::size_t pixel) const { return rays_[pixel]; }
  /// False at the edge of a fisheye, where points are farther than kMaxObliqueness × their depth: they are
  /// left out of the map.
  [[nodiscard]] bool is_used(std::size_t pixel) const { return are_all_used_ || is_used(rays_[pixel]); }
  /// Around x and y of the rays that are used, and of the optical axis.
  [[nodiscard]] const Eigen::AlignedBox2f& extent() const { return extent_; }
  [[nodiscard]] const segmentation::GridGeometry& cells() const { return cells_; }
  [[nodiscard]] const SurfaceSteps& surface_steps() const { return surface_steps_; }

 private:
  static constexpr float kMaxObliqueness = 2;
  static bool is_used(const Eigen::Vector3f& ray) {
    return ray.squaredNorm() <= kMaxObliqueness * kMaxObliqueness;
  }

  std::vector<Eigen::Vector3f> rays_;
  segmentation::GridGeometry cells_;
  SurfaceSteps surface_steps_;
  Eigen::AlignedBox2f extent_{Eigen::Vector2f(0, 0), Eigen::Vector2f(0, 0)};
  bool are_all_used_ = true;
};

/// The sampled pixels of a picture: every stride-th one of every stride-th row. Counted row by row.
struct PixelGrid {
  geometry::CameraModel camera;  // of the full picture
  int stride = 1;
  int width = 0;   // sampled columns
  int height = 0;  // sampled rows
  std::shared_ptr<const SampledRays> rays;

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row * width + column);
  }
  [[nodiscard]] int column(std::size_t pixel) const { return static_cast<int>(pixel) % width; }
  [[nodiscard]] int row(std::size_t pixel) const { return static_cast<int>(pixel) / width; }
  /// The sampled columns and rows that lie in a box of the full picture.
  [[nodiscard]] cv::Rect inside(const geometry::Box2& box) const;

  /// Calls visit(pixel, column, row) for ascending pixels: without a division for each.
  template <class Visit>
  void for_each(const std::vector<std::size_t>& pixels, Visit visit) const {
    int row = 0;
    std::size_t first = 0;  // of the row
    for (const std::size_t pixel : pixels) {
      for (; pixel >= first + static_cast<std::size_t>(width); first += static_cast<std::size_t>(width))
        ++row;
      visit(pixel, static_cast<int>(pixel - first), row);
    }
  }
};

/// Square cells of the full picture in which the tracker found motion: not 0.
struct MovableCells {
  cv::Mat1b cells;
  int side_px = 0;                   // 0: there are none
  std::vector<std::uint8_t> pixels;  // of each sampled pixel, what its cell says; empty if all say 0
};
/// Fills `pixels`. @return false if the cells do not cover the picture.
bool spread(MovableCells& movable, const PixelGrid& grid);

/// Part of the picture that shows one object: at most kMaxPoints of its points, enough to move its boundary
/// with the pose.
struct ObjectSighting {
  static constexpr std::size_t kMaxPoints = 256;
  std::uint16_t label = 0;
  float score = 0;
  bool cut_by_border = false;
  geometry::Box2 box_px;  // of the full picture
  std::vector<Eigen::Vector3f> points_in_camera;
};

/// The static objects that a detector found in a keyframe.
struct ObjectsInView {
  bool looked_for = false;            // whether a detector has seen the picture
  std::vector<std::uint16_t> labels;  // of each pixel, empty while no object is labelled; 0 = none
  std::vector<ObjectSighting> sightings;
};

/// A keyframe in the form in which it can be integrated again and again: strided, in camera coordinates.
/// Vectors have width × height entries, row by row.
struct KeyframeRecord {
  std::uint64_t id = 0;
  std::int64_t stamp_ns = 0;
  std::int64_t time_ns = 0;  // of the mapper's ContinuousTime, not stored; the stamp where none is told
  geometry::Pose map_from_camera = geometry::Pose::Identity();
  PixelGrid grid;
  std::vector<std::uint16_t> depth_tenth_mm;  // 0 = none, 65535 = 6.5 m or more
  std::vector<std::uint8_t> rgb;              // 3 per pixel
  MovableCells movable;
  PixelClasses classes;
  ObjectsInView objects;

  [[nodiscard]] std::size_t size() const { return depth_tenth_mm.size(); }
  [[nodiscard]] float depth_m(std::size_t i) const { return static_cast<float>(depth_tenth_mm[i]) * 1e-4F; }
  [[nodiscard]] Eigen::Vector3f point_in_camera(std::size_t i) const { return (*grid.rays)[i] * depth_m(i); }
};

/// Why a keyframe cannot be used, in one sentence; nullopt if it can.
std::optional<std::string> check(const KeyframeInput& input);

/// True if the tracker found something that moves there.
inline bool is_in_movable_cell(const KeyframeRecord& record, std::size_t pixel) {
  return !record.movable.pixels.empty() && record.movable.pixels[pixel] != 0;
}

/// True if boxes or the tracker know the pixel as dynamic.
inline bool is_dynamic(const KeyframeRecord& record, std::size_t pixel) {
  return record.classes[pixel] == PixelClass::kDynamic || is_in_movable_cell(record, pixel);
}

inline constexpr float kTenthMmPerM = 1e4F;
/// As depth_tenth_mm holds it.
std::uint16_t to_tenth_mm(float depth_m);

/// Samples a checked keyframe. Classes are left invalid, and boxes are not looked at.
/// @param rays  of this camera and stride, shared between records.
KeyframeRecord make_record(const KeyframeInput& input, const SamplingConfig& config,
                           std::shared_ptr<const SampledRays> rays);

}  // namespace rds::mapper
