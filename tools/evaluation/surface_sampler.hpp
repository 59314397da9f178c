// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <tl/expected.hpp>

#include "common/geometry/pose.hpp"
#include "common/image/camera_yaml.hpp"
#include "common/image/tum_list.hpp"
#include "tools/evaluation/voxels/voxel_set.hpp"

namespace rds::evaluation {

/// Every third pixel of a dataset's depth pictures as voxels of the world; depths of 0.4 … 4 m count.
class SurfaceSampler {
 public:
  /// @return or one sentence naming what cannot be read in the dataset's folder.
  static tl::expected<SurfaceSampler, std::string> open(const std::filesystem::path& dataset);

  [[nodiscard]] const std::vector<image::TumListEntry>& depth_pictures() const { return depth_.entries; }
  /// Index of the depth picture nearest in time.
  [[nodiscard]] std::size_t nearest(std::int64_t stamp_ns) const;

  /// Voxels of the surfaces in one depth picture.
  ///
  /// @param mask  CV_8UC1 of the image's size, not 0 where a pixel counts; empty: everywhere.
  /// @return or one sentence naming the picture.
  [[nodiscard]] tl::expected<VoxelSet, std::string> voxels(std::size_t picture,
                                                           const geometry::Pose& world_from_camera,
                                                           double resolution_m,
                                                           const cv::Mat& mask = {}) const;
  [[nodiscard]] cv::Size picture_size() const;

 private:
  struct Sample {
    int x;
    int y;
    Eigen::Vector3d ray;  // (x, y, 1)
  };
  image::CameraDescription camera_;
  image::TumList depth_;
  std::vector<Sample> samples_;
};

}  // namespace rds::evaluation
