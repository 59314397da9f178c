// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/obstacles/obstacle_cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

namespace rds::tracker {
namespace {

using sensor_msgs::msg::PointField;

constexpr std::uint32_t kPointBytes = 12;
constexpr double kRounding = 1e-6;  // an edge of three steps has three
constexpr int kMostSteps = 50;      // along an edge: 5 m, wider than anything that moves in a room

PointField coordinate(const std::string& name, std::uint32_t offset) {
  PointField field;
  field.name(name);
  field.offset(offset);
  field.datatype(sensor_msgs::msg::PointField_Constants::FLOAT32);
  field.count(1);
  return field;
}

/// Places along an edge, both ends among them.
std::vector<float> along(double low, double high) {
  const double wanted = std::ceil((high - low) / kObstacleStepM - kRounding);
  const int steps = static_cast<int>(std::clamp(wanted, 1.0, double{kMostSteps}));
  std::vector<float> places;
  for (int step = 0; step <= steps; ++step)
    places.push_back(static_cast<float>(low + (high - low) * step / steps));
  return places;
}

void fill(std::vector<std::uint8_t>& bytes, const geometry::Box3& box) {
  const auto xs = along(box.min.x(), box.max.x());
  const auto ys = along(box.min.y(), box.max.y());
  const auto zs = along(box.min.z(), box.max.z());
  std::size_t end = bytes.size();
  bytes.resize(end + xs.size() * ys.size() * zs.size() * kPointBytes);
  for (const float x : xs)
    for (const float y : ys)
      for (const float z : zs) {
        const std::array<float, 3> point{x, y, z};
        std::memcpy(bytes.data() + end, point.data(), kPointBytes);
        end += kPointBytes;
      }
}

}  // namespace

sensor_msgs::msg::PointCloud2 obstacle_cloud(std::span<const ImageObject> objects,
                                             const std_msgs::msg::Header& header) {
  sensor_msgs::msg::PointCloud2 cloud;
  cloud.header(header);
  cloud.fields({coordinate("x", 0), coordinate("y", 4), coordinate("z", 8)});
  cloud.point_step(kPointBytes);
  cloud.is_dense(true);
  cloud.height(1);
  for (const ImageObject& object : objects) fill(cloud.data(), object.object.box.axis_aligned_hull());
  cloud.row_step(static_cast<std::uint32_t>(cloud.data().size()));
  cloud.width(cloud.row_step() / kPointBytes);
  return cloud;
}

}  // namespace rds::tracker
