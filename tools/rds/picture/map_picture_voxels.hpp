// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unordered_set>
#include <vector>

#include "tools/rds/picture/map_picture.hpp"
#include "tools/rds/picture/map_picture_canvas.hpp"

namespace rds::tools {

/// The occupied voxels of a map in the level frame (z up), ready to be drawn.
class VoxelModel {
 public:
  /// @param level_from_map  rotation that makes `up` the z axis.
  VoxelModel(const octomap::ColorOcTree& tree, const Eigen::Matrix3d& level_from_map, double max_height_m);

  [[nodiscard]] bool empty() const { return voxels_.empty(); }
  [[nodiscard]] std::size_t size() const { return voxels_.size(); }
  /// Occupied voxels of the whole map, those too high to be shown included.
  [[nodiscard]] std::size_t total() const { return total_; }
  [[nodiscard]] double floor() const { return floor_; }
  /// Box around all but the outermost half percent at each end of each axis [m, level frame].
  [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return bounds_; }
  [[nodiscard]] Eigen::Vector3d median() const { return median_; }
  /// Number of voxels of exactly this colour.
  [[nodiscard]] std::size_t count(const cv::Vec3b& bgr) const;

  /// Draws the visible faces with light from above and ambient occlusion.
  void draw(const View& view, Canvas& canvas) const;

 private:
  struct Voxel {
    octomap::OcTreeKey key;
    Eigen::Vector3d center_in_level;
    cv::Vec3b bgr;
  };
  void measure();
  void draw_face(const Voxel& voxel, unsigned axis, int side, const View& view, Canvas& canvas) const;
  [[nodiscard]] bool is_occupied(const octomap::OcTreeKey& key, const std::array<int, 3>& offset) const;

  Eigen::Matrix3d level_from_map_;
  double resolution_;
  std::size_t total_ = 0;
  std::vector<Voxel> voxels_;
  std::unordered_set<std::uint64_t> occupied_;  // asked by key only
  Eigen::AlignedBox3d bounds_;
  Eigen::Vector3d median_ = Eigen::Vector3d::Zero();
  double floor_ = 0;
};

}  // namespace rds::tools
