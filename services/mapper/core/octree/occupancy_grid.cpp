// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree/occupancy_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "services/mapper/core/octree/voxel_walk.hpp"

namespace rds::mapper {
namespace {

constexpr int kMaxSide = 10000;       // two bytes a cell while it is made
constexpr double kFloorShare = 0.25;  // of the fullest level that a floor needs

/// Counts of voxels over one cell.
struct Column {
  std::uint8_t occupied = 0;  // no more than 255
  bool seen_free = false;
};

Eigen::Vector3d center_of(const octomap::ColorOcTree& tree, const octomap::OcTreeKey& key) {
  return {tree.keyToCoord(key[0]), tree.keyToCoord(key[1]), tree.keyToCoord(key[2])};
}

/// Voxels between the height limits in the level frame, each at the four points that leave no cell of a
/// turned grid empty.
template <class Visit>
void for_each_sample(const octomap::ColorOcTree& tree, const Eigen::Matrix3d& grid_from_map, double lowest,
                     double highest, const Visit& visit) {
  const double quarter = tree.getResolution() / 4;
  for_each_voxel(tree, [&](const octomap::OcTreeKey& key, const octomap::ColorOcTreeNode& voxel) {
    const Eigen::Vector3d p = grid_from_map * center_of(tree, key);
    if (p.z() < lowest || p.z() > highest) return;
    if (tree.isNodeOccupied(voxel)) return visit(p.x(), p.y(), true);
    for (const double dx : {-quarter, quarter})
      for (const double dy : {-quarter, quarter}) visit(p.x() + dx, p.y() + dy, false);
  });
}

std::int8_t cell_value(const Column& column, int min_occupied) {
  if (column.occupied >= min_occupied) return OccupancyGrid::kOccupied;
  return column.seen_free ? OccupancyGrid::kFree : OccupancyGrid::kUnknown;
}

}  // namespace

Eigen::Matrix3d level_frame(const Eigen::Vector3d& up_in_map) {
  const Eigen::Vector3d z = up_in_map.normalized();
  Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  if (std::abs(z.x()) > 0.9) x = Eigen::Vector3d::UnitZ();
  x = (x - z * z.dot(x)).normalized();
  Eigen::Matrix3d map_from_grid;
  map_from_grid << x, z.cross(x), z;
  return map_from_grid;
}

double floor_height(const octomap::ColorOcTree& tree, const Eigen::Vector3d& up_in_map) {
  std::map<long, int> levels;  // occupied voxels per height
  for_each_voxel(tree, [&](const octomap::OcTreeKey& key, const octomap::ColorOcTreeNode& voxel) {
    if (tree.isNodeOccupied(voxel))
      ++levels[std::lround(up_in_map.dot(center_of(tree, key)) / tree.getResolution())];
  });
  int fullest = 0;
  for (const auto& [level, count] : levels) fullest = std::max(fullest, count);
  for (const auto& [level, count] : levels)
    if (count >= kFloorShare * fullest) return static_cast<double>(level) * tree.getResolution();
  return 0;
}

OccupancyGrid make_grid(const octomap::ColorOcTree& tree, const Eigen::Vector3d& up_in_map,
                        const GridConfig& config) {
  OccupancyGrid grid;
  grid.resolution = tree.getResolution();
  const Eigen::Matrix3d map_from_grid = level_frame(up_in_map);
  const Eigen::Matrix3d grid_from_map = map_from_grid.transpose();
  const double floor = config.floor == "auto" ? floor_height(tree, up_in_map) : std::stod(config.floor);
  const double lowest = floor + config.min_height_m;
  const double highest = floor + config.max_height_m;

  constexpr int kNone = std::numeric_limits<int>::max();
  std::array<int, 4> bounds{kNone, kNone, -kNone, -kNone};
  const auto cell = [&](double metres) { return static_cast<int>(std::floor(metres / grid.resolution)); };
  for_each_sample(tree, grid_from_map, lowest, highest, [&](double x, double y, bool) {
    bounds = {std::min(bounds[0], cell(x)), std::min(bounds[1], cell(y)), std::max(bounds[2], cell(x)),
              std::max(bounds[3], cell(y))};
  });
  if (bounds[0] == kNone) return grid;
  grid.width = std::min(kMaxSide, bounds[2] - bounds[0] + 1);
  grid.height = std::min(kMaxSide, bounds[3] - bounds[1] + 1);
  grid.map_from_grid.linear() = map_from_grid;
  grid.map_from_grid.translation() =
      map_from_grid * Eigen::Vector3d(bounds[0] * grid.resolution, bounds[1] * grid.resolution, floor);

  std::vector<Column> columns(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
  for_each_sample(tree, grid_from_map, lowest, highest, [&](double x, double y, bool occupied) {
    const int column = cell(x) - bounds[0];
    const int row = cell(y) - bounds[1];
    if (column >= grid.width || row >= grid.height) return;
    auto& c = columns[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.width) +
                      static_cast<std::size_t>(column)];
    if (occupied)
      c.occupied = static_cast<std::uint8_t>(std::min(255, c.occupied + 1));
    else
      c.seen_free = true;
  });
  grid.data.reserve(columns.size());
  for (const auto& column : columns) grid.data.push_back(cell_value(column, config.min_occupied));
  return grid;
}

std::string to_pgm(const OccupancyGrid& grid) {
  std::string pgm = fmt::format("P5\n# {:.3f} m/pix\n{} {}\n255\n", grid.resolution, grid.width, grid.height);
  for (int y = grid.height - 1; y >= 0; --y)
    for (int x = 0; x < grid.width; ++x) {
      const auto value = grid.at(x, y);
      pgm.push_back(static_cast<char>(value == OccupancyGrid::kOccupied ? 0
                                      : value == OccupancyGrid::kFree   ? 254
                                                                        : 205));
    }
  return pgm;
}

std::string to_map_server_yaml(const OccupancyGrid& grid, const std::string& image_name) {
  const Eigen::Vector3d corner = grid.map_from_grid.linear().transpose() * grid.map_from_grid.translation();
  const Eigen::Quaterniond q(grid.map_from_grid.linear());
  return fmt::format(
      "# level frame of the map: x, y on the floor, z up; map_from_level as quaternion x y z w: {:.6f} "
      "{:.6f} {:.6f} "
      "{:.6f}\nimage: {}\nmode: trinary\nresolution: {:.6f}\norigin: [{:.6f}, {:.6f}, 0.0]\nnegate: 0\n"
      "occupied_thresh: 0.65\nfree_thresh: 0.196\n",
      q.x(), q.y(), q.z(), q.w(), image_name, grid.resolution, corner.x(), corner.y());
}

}  // namespace rds::mapper
