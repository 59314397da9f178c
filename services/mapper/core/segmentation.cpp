// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <pcl/features/integral_image_normal.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/comparator.h>
#include <pcl/segmentation/organized_connected_component_segmentation.h>
#include <pcl/segmentation/organized_multi_plane_segmentation.h>

namespace rds::mapper {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using Normals = pcl::PointCloud<pcl::Normal>;
using LabelCloud = pcl::PointCloud<pcl::Label>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kMaxDepthChange = 0.02F;  // share of depth: a larger step is an edge for the normals
constexpr float kNormalWindow = 7;        // pixels of the strided cloud
constexpr double kDegree = 3.14159265358979 / 180;

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

Cloud::Ptr organised_cloud(const KeyframeRecord& record, int stride) {
  auto cloud = pcl::make_shared<Cloud>();
  for (int y = 0; y < record.height; y += stride)
    for (int x = 0; x < record.width; x += stride) {
      const auto i = static_cast<std::size_t>(y * record.width + x);
      const Eigen::Vector3f p =
          record.use[i] == PixelUse::kStatic ? record.point_in_camera(i) : Eigen::Vector3f::Constant(kNan);
      cloud->push_back(Point(p.x(), p.y(), p.z()));
    }
  cloud->width = static_cast<std::uint32_t>((record.width + stride - 1) / stride);
  cloud->height = static_cast<std::uint32_t>((record.height + stride - 1) / stride);
  cloud->is_dense = false;
  return cloud;
}

Normals::Ptr normals_of(const Cloud::Ptr& cloud) {
  pcl::IntegralImageNormalEstimation<Point, pcl::Normal> estimation;
  estimation.setNormalEstimationMethod(estimation.AVERAGE_3D_GRADIENT);
  estimation.setMaxDepthChangeFactor(kMaxDepthChange);
  estimation.setNormalSmoothingSize(kNormalWindow);
  estimation.setInputCloud(cloud);
  auto normals = pcl::make_shared<Normals>();
  estimation.compute(*normals);
  return normals;
}

std::vector<pcl::PointIndices> find_planes(const Cloud::Ptr& cloud, const SegmentationConfig& config) {
  pcl::OrganizedMultiPlaneSegmentation<Point, pcl::Normal, pcl::Label> planes;
  planes.setMinInliers(
      static_cast<unsigned>(std::max(3.0, config.min_plane_share * static_cast<double>(cloud->size()))));
  planes.setAngularThreshold(config.plane_angle_deg * kDegree);
  planes.setDistanceThreshold(config.plane_distance_m);
  planes.setInputCloud(cloud);
  planes.setInputNormals(normals_of(cloud));
  std::vector<pcl::ModelCoefficients> coefficients;
  std::vector<pcl::PointIndices> inliers;
  std::vector<Eigen::Vector4f, Eigen::aligned_allocator<Eigen::Vector4f>> centroids;
  std::vector<Eigen::Matrix3f, Eigen::aligned_allocator<Eigen::Matrix3f>> covariances;
  auto labels = pcl::make_shared<LabelCloud>();
  std::vector<pcl::PointIndices> label_indices;
  planes.segment(coefficients, inliers, centroids, covariances, *labels, label_indices);
  if (!coefficients.empty()) planes.refine(coefficients, inliers, labels, label_indices);
  return inliers;
}

std::vector<pcl::PointIndices> find_clusters(const Cloud::Ptr& cloud, const SegmentationConfig& config) {
  const auto near = pcl::make_shared<NearInSpace>(static_cast<float>(config.cluster_distance));
  near->setInputCloud(cloud);
  pcl::OrganizedConnectedComponentSegmentation<Point, pcl::Label> clustering(near);
  clustering.setInputCloud(cloud);
  LabelCloud labels;
  std::vector<pcl::PointIndices> clusters;
  clustering.segment(labels, clusters);
  const double needed = config.min_cluster_share * static_cast<double>(cloud->size());
  std::erase_if(clusters, [&](const auto& c) { return static_cast<double>(c.indices.size()) < needed; });
  return clusters;
}

/// A segment from indices of the strided cloud; its pixels are those of the sampled grid.
Segment to_segment(const pcl::Indices& indices, int stride, const KeyframeRecord& record, bool is_plane) {
  const int columns = (record.width + stride - 1) / stride;
  Segment segment{{1e9, 1e9, -1e9, -1e9}, {}, is_plane};
  auto& box = segment.box_px;
  for (const int index : indices) {
    const int x = index % columns * stride;
    const int y = index / columns * stride;
    segment.pixels.push_back(static_cast<std::size_t>(y * record.width + x));
    const double s = record.stride;
    box = {std::min(box.x0, x * s), std::min(box.y0, y * s), std::max(box.x1, (x + stride) * s),
           std::max(box.y1, (y + stride) * s)};
  }
  std::ranges::sort(segment.pixels);
  return segment;
}

}  // namespace

std::vector<Segment> segment(const KeyframeRecord& record, const SegmentationConfig& config) {
  const auto cloud = organised_cloud(record, config.stride);
  std::vector<Segment> segments;
  const auto window = static_cast<std::uint32_t>(2 * kNormalWindow);
  if (cloud->width < window || cloud->height < window) return segments;
  for (const auto& plane : find_planes(cloud, config)) {
    segments.push_back(to_segment(plane.indices, config.stride, record, true));
    for (const int index : plane.indices)
      (*cloud)[static_cast<std::size_t>(index)].getVector3fMap().setConstant(kNan);
  }
  for (const auto& cluster : find_clusters(cloud, config))
    segments.push_back(to_segment(cluster.indices, config.stride, record, false));
  return segments;
}

}  // namespace rds::mapper
