// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/bundle/reduced_system.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include <Eigen/LU>

namespace rds::tracker {
namespace {

using Segment = BlockCholesky::Segment;
using CameraByPoint = Eigen::Matrix<double, 6, 3>;
using Observation = SparseBundle::Observation;

/// Huber's loss of a squared residual. Source: Triggs et al. 2000, §3.3.
struct Loss {
  double value;
  double weight;  // its derivative
};
Loss loss_of(double squared, const Measurement& measurement, bool is_robust) {
  const double bound = ObservationModel::chi2(measurement);
  if (!is_robust || squared <= bound) return {squared, 1};
  const double ratio = std::sqrt(bound / squared);
  return {2 * ratio * squared - bound, ratio};
}

/// What an observation adds to the normal equations.
struct Terms {
  Matrix6 camera;          // JcᵀJc
  CameraByPoint mixed;     // JcᵀJp
  Eigen::Matrix3d point;   // JpᵀJp
  Segment camera_gradient;
  Eigen::Vector3d point_gradient;
};

Terms terms_of(const SparseBundle& bundle, const Observation& o, const Eigen::Vector3d& position,
               bool is_robust) {
  const SparseBundle::Camera& camera = bundle.cameras[o.camera];
  const Eigen::Vector3d p = camera.camera_from_map * position;
  const Eigen::Vector3d r = camera.model.residual(p, o.measurement) + o.shift;
  const Eigen::Matrix3d by_p = camera.model.jacobian(p, o.measurement);
  const double weight = loss_of(r.squaredNorm(), o.measurement, is_robust).weight;
  Eigen::Matrix<double, 3, 6> by_camera;
  by_camera.leftCols<3>() = by_p;
  by_camera.rightCols<3>().noalias() = -by_p * skew(p);
  const Eigen::Matrix3d by_point = by_p * camera.camera_from_map.linear();
  Terms terms;
  terms.camera.noalias() = weight * by_camera.transpose() * by_camera;
  terms.mixed.noalias() = weight * by_camera.transpose() * by_point;
  terms.point.noalias() = weight * by_point.transpose() * by_point;
  terms.camera_gradient.noalias() = weight * by_camera.transpose() * r;
  terms.point_gradient.noalias() = weight * by_point.transpose() * r;
  return terms;
}

/// All observations of a point, by their rows in the matrix.
struct PointTerms {
  std::vector<std::pair<std::uint32_t, Terms>> cameras;  // those that are not fixed
  Eigen::Matrix3d hessian;
  Eigen::Vector3d gradient;

  void set(const SparseBundle& bundle, std::size_t point, std::span<const std::uint32_t> row,
           std::uint32_t fixed, bool is_robust) {
    cameras.clear();
    hessian.setZero();
    gradient.setZero();
    for (const Observation& o : bundle.seen[point]) {
      const Terms terms = terms_of(bundle, o, bundle.points[point], is_robust);
      hessian += terms.point;
      gradient += terms.point_gradient;
      if (row[o.camera] != fixed) cameras.emplace_back(row[o.camera], terms);
    }
    std::ranges::sort(cameras, {}, &std::pair<std::uint32_t, Terms>::first);
  }
  /// (H + λ diag H)⁻¹ of the point.
  [[nodiscard]] Eigen::Matrix3d inverse(double lambda) const {
    Eigen::Matrix3d damped = hessian;
    damped.diagonal() *= 1 + lambda;
    return damped.inverse();
  }
};

/// Calls visit(point's rows, ascending) for each point.
template <class Visit>
void for_each_rows(const SparseBundle& bundle, std::span<const std::uint32_t> row, std::uint32_t fixed,
                   Visit visit) {
  std::vector<std::uint32_t> rows;
  for (const std::vector<Observation>& observations : bundle.seen) {
    rows.clear();
    for (const Observation& o : observations)
      if (row[o.camera] != fixed) rows.push_back(row[o.camera]);
    std::ranges::sort(rows);
    visit(rows);
  }
}

/// Cameras that see a point in common.
Neighbours neighbours_of(const SparseBundle& bundle, std::span<const std::uint32_t> row, std::uint32_t fixed,
                         std::size_t rows) {
  std::vector<bool> is_joined(rows * rows);
  for_each_rows(bundle, row, fixed, [&](const std::vector<std::uint32_t>& seeing) {
    for (const std::uint32_t a : seeing)
      for (const std::uint32_t b : seeing) is_joined[a * rows + b] = true;
  });
  Neighbours neighbours(rows);
  for (std::size_t a = 0; a < rows; ++a)
    for (std::size_t b = 0; b < rows; ++b)
      if (a != b && is_joined[a * rows + b]) neighbours[a].push_back(static_cast<std::uint32_t>(b));
  return neighbours;
}

}  // namespace

double cost_of(const SparseBundle& bundle, bool is_robust) {
  double sum = 0;
  for (std::size_t point = 0; point < bundle.points.size(); ++point)
    for (const Observation& o : bundle.seen[point]) {
      const SparseBundle::Camera& camera = bundle.cameras[o.camera];
      const Eigen::Vector3d p = camera.camera_from_map * bundle.points[point];
      if (!(p.z() >= kMinDepth)) return std::numeric_limits<double>::infinity();
      const double squared = (camera.model.residual(p, o.measurement) + o.shift).squaredNorm();
      sum += loss_of(squared, o.measurement, is_robust).value;
    }
  return sum / 2;
}

ReducedSystem::ReducedSystem(const SparseBundle& bundle) : matrix_(Neighbours{}) {
  std::vector<bool> is_moved(bundle.cameras.size());
  for (const auto& observations : bundle.seen)
    for (const Observation& o : observations) is_moved[o.camera] = !bundle.cameras[o.camera].is_fixed;
  std::uint32_t rows = 0;
  for (const bool is_one : is_moved) row_.push_back(is_one ? rows++ : kFixed);
  const Neighbours neighbours = neighbours_of(bundle, row_, kFixed, rows);
  const auto place = elimination_order(neighbours);
  for (std::uint32_t& row : row_)
    if (row != kFixed) row = place[row];
  Neighbours eliminated(rows);
  for (std::size_t i = 0; i < rows; ++i)
    for (const std::uint32_t j : neighbours[i]) eliminated[place[i]].push_back(place[j]);
  matrix_ = BlockCholesky(eliminated);
  for_each_rows(bundle, row_, kFixed, [&](const std::vector<std::uint32_t>& seeing) {
    for (std::size_t a = 0; a < seeing.size(); ++a)
      for (std::size_t b = 0; b <= a; ++b)
        pairs_.push_back(static_cast<std::uint32_t>(matrix_.index(seeing[a], seeing[b])));
  });
}

void ReducedSystem::build(const SparseBundle& bundle, bool is_robust, double lambda) {
  matrix_.clear();
  right_.assign(matrix_.rows(), Segment::Zero());
  gradient_ = diagonal_ = right_;
  PointTerms terms;
  std::vector<CameraByPoint> over;  // W V⁻¹
  const std::uint32_t* pair = pairs_.data();
  for (std::size_t point = 0; point < bundle.points.size(); ++point) {
    terms.set(bundle, point, row_, kFixed, is_robust);
    const Eigen::Matrix3d inverse = terms.inverse(lambda);
    over.clear();
    for (std::size_t a = 0; a < terms.cameras.size(); ++a) {
      const auto& [row, camera] = terms.cameras[a];
      over.emplace_back(camera.mixed * inverse);
      gradient_[row] += camera.camera_gradient;
      diagonal_[row] += camera.camera.diagonal();
      right_[row].noalias() += over[a] * terms.gradient;
      for (std::size_t b = 0; b < a; ++b)
        matrix_[*pair++].noalias() -= over[a] * terms.cameras[b].second.mixed.transpose();
      BlockCholesky::Block& own = matrix_[*pair++];
      own += camera.camera;
      own.noalias() -= over[a] * camera.mixed.transpose();
    }
  }
  for (std::uint32_t row = 0; row < matrix_.rows(); ++row) {
    matrix_[matrix_.index(row, row)].diagonal() += lambda * diagonal_[row];
    right_[row] -= gradient_[row];
  }
}

/// From the cameras' steps: V δp = −g − Σ Wᵀδc.
void ReducedSystem::move_points(const SparseBundle& bundle, bool is_robust, double lambda,
                                BundleStep& step) const {
  PointTerms terms;
  for (std::size_t point = 0; point < bundle.points.size(); ++point) {
    terms.set(bundle, point, row_, kFixed, is_robust);
    Eigen::Vector3d right = -terms.gradient;
    for (const auto& [row, camera] : terms.cameras) right.noalias() -= camera.mixed.transpose() * right_[row];
    const Eigen::Vector3d moved = terms.inverse(lambda) * right;
    step.points.push_back(moved);
    step.expected_gain +=
        (lambda * terms.hessian.diagonal().cwiseProduct(moved) - terms.gradient).dot(moved) / 2;
  }
}

std::optional<BundleStep> ReducedSystem::solve(const SparseBundle& bundle, bool is_robust, double lambda) {
  build(bundle, is_robust, lambda);
  if (!matrix_.factor()) return std::nullopt;
  matrix_.solve(right_);
  BundleStep step;
  move_points(bundle, is_robust, lambda, step);
  for (const std::uint32_t row : row_)
    step.cameras.push_back(row == kFixed ? Twist(Twist::Zero()) : Twist(right_[row]));
  for (std::size_t row = 0; row < matrix_.rows(); ++row)
    step.expected_gain +=
        (lambda * diagonal_[row].cwiseProduct(right_[row]) - gradient_[row]).dot(right_[row]) / 2;
  return step;
}

}  // namespace rds::tracker
