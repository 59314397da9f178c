// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/triangulation/triangulation.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace rds::tracker {
namespace {

constexpr int kIterations = 6;
constexpr double kSmallStep = 1e-4;      // of the distance to the first camera
constexpr double kMaxDepthSigma = 1. / 3;  // of the depth
constexpr double kMinCondition = 1e-12;  // smallest by largest eigenvalue of the information

/// Where the rays pass nearest to each other. Nothing if they are parallel.
std::optional<Eigen::Vector3d> between_rays(std::span<const PointView> views) {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const PointView& view : views) {
    const geometry::Pose map_from_camera = view.camera_from_map.inverse();
    const Eigen::Vector3d ray = map_from_camera.linear() * view.model.ray(view.measurement.px).normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray * ray.transpose();
    a += across;
    b += across * map_from_camera.translation();
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(a);
  if (solver.rcond() < kMinCondition) return std::nullopt;
  return solver.solve(b);
}

bool is_before(const PointView& view, const Eigen::Vector3d& point_in_map) {
  return (view.camera_from_map * point_in_map).z() >= kMinDepth;
}

bool is_before_all(std::span<const PointView> views, const Eigen::Vector3d& point_in_map) {
  for (const PointView& view : views)
    if (!is_before(view, point_in_map)) return false;
  return true;
}

/// Normal equations of the residuals by the point.
struct Sums {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};

Sums linearize(std::span<const PointView> views, const Eigen::Vector3d& point_in_map) {
  Sums sums;
  for (const PointView& view : views) {
    const Eigen::Vector3d p = view.camera_from_map * point_in_map;
    const Eigen::Matrix3d j = view.model.jacobian(p, view.measurement) * view.camera_from_map.linear();
    sums.information += j.transpose() * j;
    sums.gradient += j.transpose() * view.model.residual(p, view.measurement);
  }
  return sums;
}

}  // namespace

std::optional<TriangulatedPoint> triangulate(std::span<const PointView> views) {
  const auto start = between_rays(views);
  if (!start) return std::nullopt;
  TriangulatedPoint point;
  point.position = *start;
  for (int i = 0; i < kIterations; ++i) {
    if (!is_before_all(views, point.position)) return std::nullopt;
    const Sums sums = linearize(views, point.position);
    const Eigen::LDLT<Eigen::Matrix3d> solver(sums.information);
    if (solver.rcond() < kMinCondition) return std::nullopt;
    const Eigen::Vector3d step = solver.solve(-sums.gradient);
    point.position += step;
    if (step.norm() < kSmallStep * (views.front().camera_from_map * point.position).norm()) break;
  }
  if (!is_before_all(views, point.position)) return std::nullopt;
  point.covariance = covariance_at(views, point.position);
  return point.covariance.allFinite() ? std::optional(point) : std::nullopt;
}

Eigen::Matrix3d covariance_at(std::span<const PointView> views, const Eigen::Vector3d& position) {
  return linearize(views, position).information.inverse();
}

bool is_known_well(const TriangulatedPoint& point, const PointView& view) {
  const double sigma_m = depth_sigma_m(point, view.camera_from_map);
  const double z = (view.camera_from_map * point.position).z();
  return view.model.disparity(z) * sigma_m / z <= kDisparitySigmaPx && sigma_m <= kMaxDepthSigma * z;
}

bool agrees(const PointView& view, const Eigen::Vector3d& point_in_map) {
  if (!is_before(view, point_in_map)) return false;
  return view.model.residual(view.camera_from_map * point_in_map, view.measurement).squaredNorm() <=
         ObservationModel::chi2(view.measurement);
}

double depth_sigma_m(const TriangulatedPoint& point, const geometry::Pose& camera_from_map) {
  const Eigen::RowVector3d axis = camera_from_map.linear().row(2);
  return std::sqrt(axis * point.covariance * axis.transpose());
}

double pixel_sigma_px(const TriangulatedPoint& point, const geometry::Pose& camera_from_map,
                      const ObservationModel& model) {
  const Eigen::Matrix<double, 2, 3> j =
      model.jacobian(camera_from_map * point.position, Measurement{}).topRows<2>() * camera_from_map.linear();
  const Eigen::Matrix2d covariance = j * point.covariance * j.transpose();
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).eigenvalues()(1));
}

}  // namespace rds::tracker
