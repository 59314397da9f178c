// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/truth_map.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include <octomap/OcTree.h>

namespace rds::simulator {
namespace {

using Eigen::Vector3f;

constexpr auto kSpacing = static_cast<float>(kTruthVoxelM / 2);

/// A lattice over the triangle whose cells have sides of at most kSpacing.
void add_points(const Vector3f& a, const Vector3f& b, const Vector3f& c, std::vector<Vector3f>& points) {
  const float longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  const int steps = std::max(1, static_cast<int>(std::ceil(longest / kSpacing)));
  for (int i = 0; i <= steps; ++i)
    for (int k = 0; i + k <= steps; ++k) {
      const float s = static_cast<float>(i) / static_cast<float>(steps);
      const float t = static_cast<float>(k) / static_cast<float>(steps);
      points.emplace_back(a + s * (b - a) + t * (c - a));
    }
}

}  // namespace

std::vector<Vector3f> surface_points(const Mesh& mesh) {
  std::vector<Vector3f> points;
  for (const Triangle& triangle : mesh.triangles)
    add_points(mesh.vertices[triangle.a].position, mesh.vertices[triangle.b].position,
               mesh.vertices[triangle.c].position, points);
  return points;
}

void write_truth_map(const Scene& scene, const std::filesystem::path& file) {
  octomap::OcTree tree(kTruthVoxelM);
  for (const Room& room : scene.rooms)
    for (const Vector3f& p : surface_points(room.mesh))
      tree.setNodeValue(octomap::point3d(p.x(), p.y(), p.z()), tree.getClampingThresMaxLog(), true);
  tree.updateInnerOccupancy();
  std::ofstream stream(file, std::ios::binary);
  const bool is_open = stream.is_open();
  if (is_open) tree.write(stream);
  stream.close();
  if (!is_open || !stream) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace rds::simulator
