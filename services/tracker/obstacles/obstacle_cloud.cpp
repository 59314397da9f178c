// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/obstacles/obstacle_cloud.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

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

void append(std::vector<std::uint8_t>& bytes, double number) {
  const auto bits = std::bit_cast<std::array<std::uint8_t, 4>>(static_cast<float>(number));
  bytes.insert(bytes.end(), bits.begin(), bits.end());
}

void fill(std::vector<std::uint8_t>& bytes, const geometry::Box3& box) {
  std::array<int, 3> steps{};
  for (int axis = 0; axis < 3; ++axis) {
    const double wanted = std::ceil((box.max[axis] - box.min[axis]) / kObstacleStepM - kRounding);
    steps[static_cast<std::size_t>(axis)] = static_cast<int>(std::clamp(wanted, 1.0, double{kMostSteps}));
  }
  const auto at = [&](int axis, int step) {
    return box.min[axis] + (box.max[axis] - box.min[axis]) * step / steps[static_cast<std::size_t>(axis)];
  };
  for (int x = 0; x <= steps[0]; ++x)
    for (int y = 0; y <= steps[1]; ++y)
      for (int z = 0; z <= steps[2]; ++z) {
        append(bytes, at(0, x));
        append(bytes, at(1, y));
        append(bytes, at(2, z));
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
