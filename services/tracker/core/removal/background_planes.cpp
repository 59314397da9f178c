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
constexpr float kNarrow_m = 0.06F;  // standard deviation along the narrower side: a strip of 0.2 m, and …
constexpr float kWide_m = 0.16F;    // wider than 0.55 m
constexpr float kMinCosine = 0.8F;  // between the plane's normal and a cell's
constexpr float kMinSine = 0.2F;    // of the triangle that makes a hypothesis

float tolerance_m(float depth_m) {
  return 0.012F + 0.005F * depth_m * depth_m;
}

Eigen::Vector3f point_of(const cv::Mat1f& depth_m, const GridGeometry& grid, const cv::Point& cell) {
  return depth_m(cell) * grid.ray(cell.x, cell.y);
}

bool is_near(const Plane& plane, const Eigen::Vector3f& p) {
  return std::abs(plane.normal.dot(p) - plane.distance) < tolerance_m(p.z());
}

/// Where a cell's surface is, and which way it faces: zero where that is not known.
struct Sample {
  Eigen::Vector3f point;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
};

Sample sample_of(const cv::Mat1f& depth_m, const GridGeometry& grid, const cv::Point& cell) {
  Sample sample{point_of(depth_m, grid, cell)};
  if (!cv::Rect(1, 1, depth_m.cols - 2, depth_m.rows - 2).contains(cell)) return sample;
  constexpr double kStep = 0.08;
  std::array<Eigen::Vector3f, 4> around;
  const std::array<cv::Point, 4> neighbours{cell + cv::Point(1, 0), cell - cv::Point(1, 0),
                                            cell + cv::Point(0, 1), cell - cv::Point(0, 1)};
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    const float z = depth_m(neighbours[i]);
    if (!(z > 0) || !one_surface(z, depth_m(cell), kStep)) return sample;
    around[i] = point_of(depth_m, grid, neighbours[i]);
  }
  sample.normal = (around[0] - around[1]).cross(around[2] - around[3]).normalized();
  return sample;
}

/// Near the plane, and parallel to it as far as is known.
bool agrees(const Plane& plane, const Sample& sample) {
  return is_near(plane, sample.point) &&
         (sample.normal.isZero() || std::abs(sample.normal.dot(plane.normal)) > kMinCosine);
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

/// The plane that fits best; nullopt for a strip, which an arm or a leg can be.
std::optional<Plane> fit(const std::vector<Sample>& samples) {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const Sample& s : samples) mean += s.point;
  mean /= static_cast<float>(samples.size());
  Eigen::Matrix3f scatter = Eigen::Matrix3f::Zero();
  for (const Sample& s : samples) scatter += (s.point - mean) * (s.point - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(scatter);
  const Eigen::Vector3f normal = solver.eigenvectors().col(0);
  const float variance = solver.eigenvalues()(1) / static_cast<float>(samples.size());
  if (variance < kNarrow_m * kNarrow_m) return std::nullopt;
  return Plane{normal, normal.dot(mean), variance > kWide_m * kWide_m};
}

std::optional<Plane> best_plane(const std::vector<Sample>& samples, Sequence& sequence) {
  std::optional<Plane> best;
  std::size_t most = 0;
  const std::size_t stride = std::max<std::size_t>(1, samples.size() / kMaxAsked);
  for (int h = 0; h < kHypotheses; ++h) {
    const std::size_t middle = sequence.below(samples.size());
    const auto other = [&] {
      const std::size_t step = sequence.below(samples.size() / 4 + kNear);
      return samples[std::min(samples.size() - 1, middle + step)].point;
    };
    const auto plane = plane_through({samples[middle].point, other(), other()});
    if (!plane) continue;
    std::size_t agree = 0;
    for (std::size_t i = 0; i < samples.size(); i += stride) agree += agrees(*plane, samples[i]) ? 1 : 0;
    if (agree > most) {
      most = agree;
      best = plane;
    }
  }
  return most * stride >= kMinCells ? best : std::nullopt;
}

}  // namespace

std::vector<Plane> find_planes(const cv::Mat1f& depth_m, const GridGeometry& grid,
                               const std::vector<cv::Point>& cells) {
  std::vector<Plane> planes;
  Sequence sequence;
  std::vector<Sample> samples;
  samples.reserve(cells.size());
  for (const cv::Point& cell : cells) samples.push_back(sample_of(depth_m, grid, cell));
  for (int i = 0; i < kMaxPlanes && samples.size() >= kMinCells; ++i) {
    const auto found = best_plane(samples, sequence);
    if (!found) break;
    std::vector<Sample> on_plane;
    std::ranges::copy_if(samples, std::back_inserter(on_plane),
                         [&](const Sample& s) { return agrees(*found, s); });
    if (on_plane.size() < kMinCells) break;
    const auto plane = fit(on_plane);
    if (plane) planes.push_back(*plane);
    std::erase_if(samples,
                  [&](const Sample& s) { return agrees(*found, s) || (plane && agrees(*plane, s)); });
  }
  return planes;
}

bool lies_on(const Plane& plane, const cv::Mat1f& depth_m, const GridGeometry& grid, const cv::Point& cell) {
  return is_near(plane, point_of(depth_m, grid, cell)) && agrees(plane, sample_of(depth_m, grid, cell));
}

}  // namespace rds::tracker
