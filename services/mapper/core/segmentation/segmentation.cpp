// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/segmentation.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/comparator.h>
#include <pcl/segmentation/organized_connected_component_segmentation.h>

namespace rds::mapper {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using LabelCloud = pcl::PointCloud<pcl::Label>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kMinClusterShare = 0.0033;  // of the picture: a tenth of a plane's
/// Between neighbours, × depth: twice that of two points on a surface seen straight on.
constexpr float kClusterDistance = 0.015F;
/// Depth step between a point of a cluster and the pixels it stands for.
constexpr int kSameSurfaceTenthMm = 500;

/// Neighbours belong together when they are nearer than a share of their depth (PCL's own comparator grows
/// with depth², and joins everything at 3 m).
class NearInSpace : public pcl::Comparator<Point> {
 public:
  explicit NearInSpace(float share_of_depth) : share_of_depth_(share_of_depth) {}
  bool compare(int a, int b) const override {
    const auto p = (*input_)[static_cast<std::size_t>(a)].getVector3fMap();
    const auto q = (*input_)[static_cast<std::size_t>(b)].getVector3fMap();
    return (p - q).norm() < share_of_depth_ * p.z();  // false for NaN
  }

 private:
  float share_of_depth_;
};

/// The static points that are on no plane, NaN for all others.
Cloud::Ptr organised_cloud(const KeyframeRecord& record, const std::vector<std::uint8_t>& on_plane,
                           int stride) {
  auto cloud = pcl::make_shared<Cloud>();
  cloud->reserve(record.size() / static_cast<std::size_t>(stride));
  for (int y = 0; y < record.grid.height; y += stride)
    for (int x = 0; x < record.grid.width; x += stride) {
      const auto i = record.grid.index(x, y);
      const bool used = looks_static(record.classes[i]) && on_plane[i] == 0;
      const Eigen::Vector3f p = used ? record.point_in_camera(i) : Eigen::Vector3f::Constant(kNan);
      cloud->push_back(Point(p.x(), p.y(), p.z()));
    }
  cloud->width = static_cast<std::uint32_t>((record.grid.width + stride - 1) / stride);
  cloud->height = static_cast<std::uint32_t>((record.grid.height + stride - 1) / stride);
  cloud->is_dense = false;
  return cloud;
}

std::vector<pcl::PointIndices> find_clusters(const Cloud::Ptr& cloud) {
  const auto near = pcl::make_shared<NearInSpace>(kClusterDistance);
  near->setInputCloud(cloud);
  pcl::OrganizedConnectedComponentSegmentation<Point, pcl::Label> clustering(near);
  clustering.setInputCloud(cloud);
  LabelCloud labels;
  std::vector<pcl::PointIndices> clusters;
  clustering.segment(labels, clusters);
  const double needed = kMinClusterShare * static_cast<double>(cloud->size());
  std::erase_if(clusters, [&](const auto& c) { return static_cast<double>(c.indices.size()) < needed; });
  return clusters;
}

/// All sampled pixels that the points of a cluster, which are every `stride`-th of every `stride`-th row,
/// stand for.
std::vector<std::size_t> pixels_of(const pcl::Indices& indices, int stride, const KeyframeRecord& record,
                                   const std::vector<std::uint8_t>& on_plane) {
  const int columns = (record.grid.width + stride - 1) / stride;
  std::vector<std::size_t> pixels;
  for (const int index : indices) {
    const int x0 = index % columns * stride;
    const int y0 = index / columns * stride;
    const int depth = record.depth_tenth_mm[record.grid.index(x0, y0)];
    for (int y = y0; y < std::min(record.grid.height, y0 + stride); ++y)
      for (int x = x0; x < std::min(record.grid.width, x0 + stride); ++x) {
        const auto i = record.grid.index(x, y);
        if (on_plane[i] == 0 && std::abs(record.depth_tenth_mm[i] - depth) <= kSameSurfaceTenthMm)
          pixels.push_back(i);
      }
  }
  std::ranges::sort(pixels);
  return pixels;
}

geometry::Box2 box_around(const std::vector<std::size_t>& pixels, const KeyframeRecord& record) {
  geometry::Box2 box{1e9, 1e9, -1e9, -1e9};
  const double s = record.grid.stride;
  record.grid.for_each(pixels, [&](std::size_t, int x, int y) {
    box = {std::min(box.x0, x * s), std::min(box.y0, y * s), std::max(box.x1, (x + 1) * s),
           std::max(box.y1, (y + 1) * s)};
  });
  return box;
}

}  // namespace

std::vector<Segment> segment(const KeyframeRecord& record, const MapperConfig& config) {
  const int stride = config.segmentation.stride;
  std::vector<Segment> segments;
  std::vector<std::uint8_t> on_plane(record.size(), 0);
  for (auto& surface : find_planes(record, config.sampling.depth_noise)) {
    for (const auto i : surface.pixels) on_plane[i] = 1;
    const auto box = box_around(surface.pixels, record);
    segments.push_back({box, std::move(surface.pixels), surface.plane});
  }
  for (const auto& cluster : find_clusters(organised_cloud(record, on_plane, stride))) {
    auto pixels = pixels_of(cluster.indices, stride, record, on_plane);
    const auto box = box_around(pixels, record);
    segments.push_back({box, std::move(pixels), std::nullopt});
  }
  return segments;
}

}  // namespace rds::mapper
