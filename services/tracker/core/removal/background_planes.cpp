// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/removal/background_planes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "services/tracker/core/removal/surface_growth.hpp"

namespace rds::tracker {
namespace {

constexpr int kMaxPlanes = 4;
constexpr int kHypotheses = 40;
constexpr std::size_t kMinCells = 60;   // of a plane
constexpr std::size_t kMaxAsked = 300;  // cells that judge a hypothesis
constexpr std::size_t kNear = 12;       // of the cells in order, that a hypothesis is made of
constexpr float kWide_m = 0.16F;        // standard deviation along the narrower side: wider than 0.55 m
constexpr float kMinCosine = 0.8F;      // between the plane's normal and a cell's
constexpr float kMinSine = 0.2F;        // of the triangle that makes a hypothesis

float tolerance_m(float depth_m) {
  return 0.012F + 0.005F * depth_m * depth_m;
}

Eigen::Vector3f point_of(const cv::Mat1f& depth_m, const GridGeometry& grid, const cv::Point& cell) {
  return depth_m(cell) * grid.ray(cell.x, cell.y);
}

bool is_near(const Plane& plane, const Eigen::Vector3f& p) {
  return std::abs(plane.normal.dot(p) - plane.distance) < tolerance_m(p.z());
}

/// Numbers that only look random.
class Sequence {
 public:
  std::size_t below(std::size_t bound) {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::size_t>(state_ >> 33U) % bound;
  }

 private:
  std::uint64_t state_ = 1;
};

std::optional<Plane> plane_through(const std::array<Eigen::Vector3f, 3>& p) {
  const Eigen::Vector3f a = p[1] - p[0];
  const Eigen::Vector3f b = p[2] - p[0];
  const Eigen::Vector3f normal = a.cross(b);
  if (!(normal.norm() > kMinSine * a.norm() * b.norm())) return std::nullopt;
  const Eigen::Vector3f unit = normal.normalized();
  return Plane{unit, unit.dot(p[0]), false};
}

Plane fit(const std::vector<Eigen::Vector3f>& points) {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const auto& p : points) mean += p;
  mean /= static_cast<float>(points.size());
  Eigen::Matrix3f scatter = Eigen::Matrix3f::Zero();
  for (const auto& p : points) scatter += (p - mean) * (p - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(scatter);
  const Eigen::Vector3f normal = solver.eigenvectors().col(0);
  const float variance = solver.eigenvalues()(1) / static_cast<float>(points.size());
  return {normal, normal.dot(mean), variance > kWide_m * kWide_m};
}

std::optional<Plane> best_plane(const std::vector<Eigen::Vector3f>& points, Sequence& sequence) {
  std::optional<Plane> best;
  std::size_t most = 0;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kMaxAsked);
  for (int h = 0; h < kHypotheses; ++h) {
    const std::size_t middle = sequence.below(points.size());
    const auto other = [&] {
      const std::size_t step = sequence.below(points.size() / 4 + kNear);
      return std::min(points.size() - 1, middle + step);
    };
    const auto plane = plane_through({points[middle], points[other()], points[other()]});
    if (!plane) continue;
    std::size_t agree = 0;
    for (std::size_t i = 0; i < points.size(); i += stride) agree += is_near(*plane, points[i]) ? 1 : 0;
    if (agree > most) {
      most = agree;
      best = plane;
    }
  }
  return most * stride >= kMinCells ? best : std::nullopt;
}

}  // namespace

std::vector<Plane> find_planes(const cv::Mat1f& depth_m, const GridGeometry& grid,
                               std::vector<cv::Point> cells) {
  std::vector<Plane> planes;
  Sequence sequence;
  std::vector<Eigen::Vector3f> points;
  points.reserve(cells.size());
  for (const cv::Point& cell : cells) points.push_back(point_of(depth_m, grid, cell));
  for (int i = 0; i < kMaxPlanes && points.size() >= kMinCells; ++i) {
    const auto found = best_plane(points, sequence);
    if (!found) break;
    std::vector<Eigen::Vector3f> on_plane;
    std::ranges::copy_if(points, std::back_inserter(on_plane),
                         [&](const auto& p) { return is_near(*found, p); });
    if (on_plane.size() < kMinCells) break;
    planes.push_back(fit(on_plane));
    std::erase_if(points, [&](const auto& p) { return is_near(planes.back(), p) || is_near(*found, p); });
  }
  return planes;
}

bool lies_on(const Plane& plane, const cv::Mat1f& depth_m, const GridGeometry& grid, const cv::Point& cell) {
  const float z = depth_m(cell);
  if (!is_near(plane, point_of(depth_m, grid, cell))) return false;
  const cv::Rect inner(1, 1, depth_m.cols - 2, depth_m.rows - 2);
  if (!inner.contains(cell)) return true;
  constexpr double kStep = 0.08;
  std::array<Eigen::Vector3f, 4> around;
  const std::array<cv::Point, 4> neighbours{cell + cv::Point(1, 0), cell - cv::Point(1, 0),
                                            cell + cv::Point(0, 1), cell - cv::Point(0, 1)};
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    if (!(depth_m(neighbours[i]) > 0) || !one_surface(depth_m(neighbours[i]), z, kStep)) return true;
    around[i] = point_of(depth_m, grid, neighbours[i]);
  }
  const Eigen::Vector3f normal = (around[0] - around[1]).cross(around[2] - around[3]).normalized();
  return std::abs(normal.dot(plane.normal)) > kMinCosine;
}

}  // namespace rds::tracker
