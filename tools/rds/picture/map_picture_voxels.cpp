// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/picture/map_picture_voxels.hpp"

#include <algorithm>
#include <cmath>

namespace rds::tools {
namespace {

constexpr double kOutliers = 0.005;
constexpr float kAmbient = 0.62F;
constexpr float kCreaseShade = 0.13F;  // per occupied neighbour at a corner

std::uint64_t packed(const octomap::OcTreeKey& key) {
  return std::uint64_t{key[0]} << 32 | std::uint64_t{key[1]} << 16 | key[2];
}

}  // namespace

VoxelModel::VoxelModel(const octomap::ColorOcTree& tree, const Eigen::Matrix3d& level_from_map,
                       double max_height_m)
    : level_from_map_(level_from_map), resolution_(tree.getResolution()) {
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    const auto color = leaf->getColor();
    voxels_.push_back({leaf.getKey(), level_from_map * Eigen::Vector3d(leaf.getX(), leaf.getY(), leaf.getZ()),
                       cv::Vec3b(color.b, color.g, color.r)});
  }
  total_ = voxels_.size();
  if (voxels_.empty()) return;
  measure();
  const double highest = floor_ + max_height_m;
  std::erase_if(voxels_, [&](const Voxel& v) { return v.center_in_level.z() > highest; });
  for (const auto& voxel : voxels_) occupied_.insert(packed(voxel.key));
  measure();
}

void VoxelModel::measure() {
  bounds_.setEmpty();
  std::vector<double> values(voxels_.size());
  if (voxels_.empty()) return;
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  Eigen::Vector3d high = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(voxels_, values.begin(),
                           [axis](const Voxel& v) { return v.center_in_level[axis]; });
    std::ranges::sort(values);
    const auto cut = static_cast<std::size_t>(kOutliers * static_cast<double>(values.size()));
    low[axis] = values[cut];
    high[axis] = values[values.size() - 1 - cut];
    median_[axis] = values[values.size() / 2];
  }
  bounds_ = Eigen::AlignedBox3d(low, high);
  floor_ = low.z();
}

std::size_t VoxelModel::count(const cv::Vec3b& bgr) const {
  return static_cast<std::size_t>(std::ranges::count(voxels_, bgr, &Voxel::bgr));
}

bool VoxelModel::is_occupied(const octomap::OcTreeKey& key, const std::array<int, 3>& offset) const {
  return occupied_.contains(
      packed({static_cast<std::uint16_t>(key[0] + offset[0]), static_cast<std::uint16_t>(key[1] + offset[1]),
              static_cast<std::uint16_t>(key[2] + offset[2])}));
}

void VoxelModel::draw(const View& view, Canvas& canvas) const {
  for (const auto& voxel : voxels_)
    for (unsigned axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) draw_face(voxel, axis, side, view, canvas);
}

void VoxelModel::draw_face(const Voxel& voxel, unsigned axis, int side, const View& view,
                           Canvas& canvas) const {
  std::array<int, 3> out{};
  out[axis] = side;
  if (is_occupied(voxel.key, out)) return;
  const Eigen::Vector3d normal = level_from_map_.col(static_cast<Eigen::Index>(axis)) * side;
  const Eigen::Vector3d face = voxel.center_in_level + normal * (resolution_ / 2);
  const Eigen::Vector3d sight =
      view.is_parallel ? view.eye_from_level.row(2).transpose() : Eigen::Vector3d(face - view.eye_in_level);
  if (normal.dot(sight) >= 0) return;

  const Eigen::Vector3d light = Eigen::Vector3d(0.35, -0.45, 0.82).normalized();
  const float shade = kAmbient + (1.12F - kAmbient) * static_cast<float>(0.5 + 0.5 * normal.dot(light));
  const unsigned u = (axis + 1) % 3;
  const unsigned v = (axis + 2) % 3;
  constexpr std::array<std::array<int, 2>, 4> kCorners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  std::array<ScreenPoint, 4> corners;
  std::array<float, 4> brightness{};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto [a, b] = kCorners[i];
    corners[i] = view.project(face + (level_from_map_.col(static_cast<Eigen::Index>(u)) * a +
                                      level_from_map_.col(static_cast<Eigen::Index>(v)) * b) *
                                         (resolution_ / 2));
    auto beside_u = out;
    auto beside_v = out;
    beside_u[u] = a;
    beside_v[v] = b;
    auto diagonal = beside_u;
    diagonal[v] = b;
    const int crowd = int{is_occupied(voxel.key, beside_u)} + int{is_occupied(voxel.key, beside_v)} +
                      int{is_occupied(voxel.key, diagonal)};
    brightness[i] = shade * (1 - kCreaseShade * static_cast<float>(crowd));
  }
  canvas.fill(corners, brightness, cv::Vec3f(voxel.bgr));
}

}  // namespace rds::tools
