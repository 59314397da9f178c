// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/adjustment/bundle_solver.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include <Eigen/LU>

#include "services/tracker/core/adjustment/block_cholesky.hpp"
#include "services/tracker/core/pose/robust_loss.hpp"

namespace rds::tracker {
namespace {

constexpr double kFirstDamping = 1e-4;  // λ: a share of the diagonal of the normal equations
constexpr double kLeastDamping = 1e-9;
constexpr double kMostDamping = 1e3;
constexpr double kDampingStep = 10;
constexpr double kEnough = 1e-6;  // share of the cost; an iteration that gains less is the last
constexpr std::size_t kNotMoved = std::numeric_limits<std::size_t>::max();

/// A weighted residual and its derivatives: by a motion ξ of the camera, exp(ξ) · camera_from_map, and by the
/// point.
struct LinearisedObservation {
  Eigen::Vector3d residual;
  Eigen::Matrix<double, 3, 6> by_camera;
  Eigen::Matrix3d by_point;
};

LinearisedObservation linearise(const BundleCamera& camera, const BundleObservation& observation,
                                const Eigen::Vector3d& position) {
  const Eigen::Vector3d p = camera.camera_from_map * position;
  LinearisedObservation l;
  l.residual = camera.model.residual(p, observation.measurement) + observation.shift;
  l.by_camera.leftCols<3>() = camera.model.jacobian(p, observation.measurement);
  l.by_camera.rightCols<3>() = -l.by_camera.leftCols<3>() * skew(p);
  l.by_point = l.by_camera.leftCols<3>() * camera.camera_from_map.linear();
  return l;
}

/// An observation at the present estimate; everything times the root of its weight.
struct Seen {
  std::size_t unknown = kNotMoved;  // of the camera
  LinearisedObservation at;
  Eigen::Matrix<double, 6, 3> coupling;  // by_cameraᵀ by_point
};

/// The part of the normal equations that is a point's own: V x + Σ couplingᵀ ξ = −gradient.
struct PointEquations {
  Eigen::Matrix3d inverse;  // of the damped V
  Eigen::Vector3d gradient;
};

class Solver {
 public:
  Solver(Bundle& bundle, bool is_robust)
      : bundle_(bundle), is_robust_(is_robust), unknowns_(number_cameras()), equations_(count_, couples()) {}

  [[nodiscard]] double cost() const {
    double sum = 0;
    for (const BundlePoint& point : bundle_.points)
      for (const BundleObservation& o : point.observations) {
        const BundleCamera& camera = bundle_.cameras[o.camera];
        const Eigen::Vector3d p = camera.camera_from_map * point.position;
        if (p.z() < kMinDepth) return std::numeric_limits<double>::infinity();
        const Eigen::Vector3d r = camera.model.residual(p, o.measurement) + o.shift;
        sum += robust_loss(r.squaredNorm(), ObservationModel::chi2(o.measurement), is_robust_).cost;
      }
    return sum;
  }

  /// @return false if there is no step.
  bool step(double damping) {
    build(damping);
    if (!equations_.factorize()) return false;
    equations_.solve(steps_);
    if (!std::ranges::all_of(steps_, [](const Twist& s) { return s.allFinite(); })) return false;
    move_points(damping);
    move_cameras();
    return true;
  }

 private:
  std::vector<std::size_t> number_cameras() {
    std::vector<bool> sees(bundle_.cameras.size());
    for (const BundlePoint& point : bundle_.points)
      for (const BundleObservation& o : point.observations) sees[o.camera] = true;
    std::vector<std::size_t> unknowns(bundle_.cameras.size(), kNotMoved);
    for (std::size_t c = 0; c < unknowns.size(); ++c)
      if (sees[c] && !bundle_.cameras[c].is_fixed) unknowns[c] = count_++;
    return unknowns;
  }

  /// Cameras that see a point together.
  [[nodiscard]] BlockCholesky::Couples couples() const {
    std::vector<std::vector<bool>> known(count_);
    BlockCholesky::Couples couples;
    for (const BundlePoint& point : bundle_.points)
      for (const BundleObservation& a : point.observations)
        for (const BundleObservation& b : point.observations) {
          const std::size_t row = unknowns_[a.camera];
          const std::size_t column = unknowns_[b.camera];
          if (row == kNotMoved || column == kNotMoved || row <= column) continue;
          known[row].resize(row);
          if (known[row][column]) continue;
          known[row][column] = true;
          couples.emplace_back(row, column);
        }
    return couples;
  }

  void see(const BundlePoint& point) {
    seen_.resize(point.observations.size());
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const BundleObservation& o = point.observations[i];
      LinearisedObservation l = linearise(bundle_.cameras[o.camera], o, point.position);
      const double bound = ObservationModel::chi2(o.measurement);
      const double root = std::sqrt(robust_loss(l.residual.squaredNorm(), bound, is_robust_).weight);
      l.residual *= root;
      l.by_camera *= root;
      l.by_point *= root;
      seen_[i] = {unknowns_[o.camera], l, l.by_camera.transpose() * l.by_point};
    }
  }

  [[nodiscard]] PointEquations point_equations(double damping) const {
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
    PointEquations own{{}, Eigen::Vector3d::Zero()};
    for (const Seen& s : seen_) {
      hessian.noalias() += s.at.by_point.transpose() * s.at.by_point;
      own.gradient.noalias() += s.at.by_point.transpose() * s.at.residual;
    }
    hessian.diagonal() *= 1 + damping;
    own.inverse = hessian.inverse();
    return own;
  }

  /// The normal equations of the cameras, the points eliminated.
  void build(double damping) {
    equations_.set_zero();
    steps_.assign(count_, Twist::Zero());
    diagonal_.assign(count_, Twist::Zero());
    for (const BundlePoint& point : bundle_.points) {
      see(point);
      for (const Seen& s : seen_) {
        if (s.unknown == kNotMoved) continue;
        equations_.diagonal(s.unknown).noalias() += s.at.by_camera.transpose() * s.at.by_camera;
        diagonal_[s.unknown] += s.at.by_camera.colwise().squaredNorm().transpose();
        steps_[s.unknown].noalias() -= s.at.by_camera.transpose() * s.at.residual;
      }
      eliminate(point_equations(damping));
    }
    for (std::size_t c = 0; c < count_; ++c)
      equations_.diagonal(c).diagonal() += damping * diagonal_[c];
  }

  void eliminate(const PointEquations& own) {
    for (std::size_t a = 0; a < seen_.size(); ++a) {
      if (seen_[a].unknown == kNotMoved) continue;
      const Eigen::Matrix<double, 6, 3> by_inverse = seen_[a].coupling * own.inverse;
      steps_[seen_[a].unknown].noalias() += by_inverse * own.gradient;
      equations_.diagonal(seen_[a].unknown).noalias() -= by_inverse * seen_[a].coupling.transpose();
      for (std::size_t b = 0; b < a; ++b)
        if (seen_[b].unknown != kNotMoved)
          equations_.add(seen_[a].unknown, seen_[b].unknown, -by_inverse * seen_[b].coupling.transpose());
    }
  }

  /// By the steps of the cameras, which have not moved yet.
  void move_points(double damping) {
    for (BundlePoint& point : bundle_.points) {
      see(point);
      const PointEquations own = point_equations(damping);
      Eigen::Vector3d sum = own.gradient;
      for (const Seen& s : seen_)
        if (s.unknown != kNotMoved) sum.noalias() += s.coupling.transpose() * steps_[s.unknown];
      point.position -= own.inverse * sum;
    }
  }

  void move_cameras() {
    for (std::size_t c = 0; c < unknowns_.size(); ++c) {
      if (unknowns_[c] == kNotMoved) continue;
      geometry::Pose& pose = bundle_.cameras[c].camera_from_map;
      const geometry::Pose moved = se3_exp(steps_[unknowns_[c]]) * pose;
      // Accumulated products of rotations drift from orthonormality.
      pose = geometry::make_pose(moved.translation(), Eigen::Quaterniond(moved.linear()));
    }
  }

  Bundle& bundle_;
  bool is_robust_;
  std::size_t count_ = 0;  // unknown cameras
  std::vector<std::size_t> unknowns_;  // per camera
  BlockCholesky equations_;
  std::vector<Twist> steps_;           // the right side, then the solution
  std::vector<Twist> diagonal_;        // of the cameras' normal equations, before points are eliminated
  std::vector<Seen> seen_;             // of one point
};

/// Where everything is, to go back to.
struct Estimate {
  explicit Estimate(const Bundle& bundle) {
    for (const BundleCamera& camera : bundle.cameras) poses.push_back(camera.camera_from_map);
    for (const BundlePoint& point : bundle.points) positions.push_back(point.position);
  }
  void restore(Bundle& bundle) const {
    for (std::size_t i = 0; i < poses.size(); ++i) bundle.cameras[i].camera_from_map = poses[i];
    for (std::size_t i = 0; i < positions.size(); ++i) bundle.points[i].position = positions[i];
  }
  std::vector<geometry::Pose> poses;
  std::vector<Eigen::Vector3d> positions;
};

}  // namespace

void solve_bundle(Bundle& bundle, const BundleSolverOptions& options) {
  Solver solver(bundle, options.is_robust);
  double damping = kFirstDamping;
  double cost = solver.cost();
  for (int i = 0; i < options.iterations && !options.stop.stop_requested(); ++i) {
    const Estimate before(bundle);
    const double moved = solver.step(damping) ? solver.cost() : std::numeric_limits<double>::infinity();
    if (moved <= cost) {
      const bool is_last = cost - moved <= kEnough * cost;
      cost = moved;
      damping = std::max(damping / kDampingStep, kLeastDamping);
      if (is_last) return;
    } else {
      before.restore(bundle);
      damping *= kDampingStep;
      if (damping > kMostDamping) return;
    }
  }
}

}  // namespace rds::tracker
