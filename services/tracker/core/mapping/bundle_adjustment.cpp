// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <ceres/ceres.h>

#include "services/tracker/core/adjustment/bundle_solver.hpp"
#include "services/tracker/core/mapping/mapping_scene.hpp"
#include "services/tracker/core/motion/se3.hpp"
#include "services/tracker/core/pose/observation_model.hpp"

namespace rds::tracker {
namespace {

using PoseBlock = std::array<double, 7>;  // camera_from_map: qx qy qz qw x y z

PoseBlock to_block(const Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d t = pose.translation();
  return {q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z()};
}

Pose to_pose(const double* block) {
  return geometry::make_pose({block[4], block[5], block[6]},
                             Eigen::Quaterniond(block[3], block[0], block[1], block[2]));
}

/// camera_from_map ⊞ ξ = exp(ξ) · camera_from_map. Cost functions give derivatives by ξ in the first six
/// columns, so the manifold's own derivative only drops the seventh.
class PoseManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    const Pose moved = se3_exp(Eigen::Map<const Twist>(delta)) * to_pose(x);
    std::ranges::copy(to_block(moved), x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double* /*x*/, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>> j(jacobian);
    j.setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    Eigen::Map<Twist> difference(y_minus_x);
    difference = se3_log(to_pose(y) * to_pose(x).inverse());
    return true;
  }
  bool MinusJacobian(const double* /*x*/, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> j(jacobian);
    j.setIdentity();
    return true;
  }
};

class ReprojectionCost final : public ceres::SizedCostFunction<3, 7, 3> {
 public:
  /// @param shift  of the weighted residual.
  ReprojectionCost(const ObservationModel& model, const Measurement& measurement,
                   const Eigen::Vector3d& shift)
      : model_(model), measurement_(measurement), shift_(shift) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Pose camera_from_map = to_pose(parameters[0]);
    const Eigen::Vector3d p = camera_from_map * Eigen::Map<const Eigen::Vector3d>(parameters[1]);
    if (p.z() < kMinDepth) return false;
    Eigen::Map<Eigen::Vector3d> r(residuals);
    r = model_.residual(p, measurement_) + shift_;
    if (jacobians == nullptr) return true;
    const Eigen::Matrix3d by_point = model_.jacobian(p, measurement_);
    if (jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 3, 7, Eigen::RowMajor>> j(jacobians[0]);
      j.leftCols<3>() = by_point;
      j.middleCols<3>(3) = -by_point * skew(p);
      j.col(6).setZero();
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> j(jacobians[1]);
      j = by_point * camera_from_map.linear();
    }
    return true;
  }

 private:
  ObservationModel model_;
  Measurement measurement_;
  Eigen::Vector3d shift_;
};

/// Ends the solver when it is told to stop.
class StopCallback final : public ceres::IterationCallback {
 public:
  explicit StopCallback(std::stop_token stop) : stop_(std::move(stop)) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*summary*/) override {
    return stop_.stop_requested() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  std::stop_token stop_;
};

/// The same bits every time: one thread, no threaded BLAS, no time limit.
ceres::Solver::Options solver_options(const BundleOptions& bundle) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = bundle.iterations;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  return options;
}

class Adjuster {
 public:
  explicit Adjuster(MappingScene& scene) : scene_(scene) {
    for (const MappingKeyframe& k : scene.job().keyframes) {
      poses_.push_back(to_block(k.map_from_camera.inverse()));
      models_.emplace_back(known_camera(k, scene.job()));
    }
  }

  void optimize(const BundleOptions& options, bool robust) {
    options.is_sparse ? optimize_sparse(options, robust) : optimize_dense(options, robust);
  }

  /// Removes observations of points that lie behind their camera: the solver could not even begin.
  void remove_impossible(LocalMappingResult& result) {
    keep(result, [this](const MappingScene::SceneObservation& o, const Eigen::Vector3d& map_point) {
      return in_camera(o, map_point).z() >= kMinDepth;
    });
  }

  /// Removes observations beyond the χ² bound; what remains of a point must be seen.
  void remove_outliers(LocalMappingResult& result) {
    keep(result, [this](const MappingScene::SceneObservation& o, const Eigen::Vector3d& map_point) {
      const Measurement m = measurement(o);
      const Eigen::Vector3d p = in_camera(o, map_point);
      return p.z() >= kMinDepth &&
             models_[o.keyframe].residual(p, m).squaredNorm() <= ObservationModel::chi2(m);
    });
  }

  void report(LocalMappingResult& result) const {
    const auto& keyframes = scene_.job().keyframes;
    for (std::size_t k = 0; k < poses_.size(); ++k)
      if (!keyframes[k].fixed)
        result.keyframes.push_back({keyframes[k].id, to_pose(poses_[k].data()).inverse()});
    for (const auto& point : scene_.points()) {
      if (is_adjusted(point))
        result.points.push_back({point.id, point.position});
      else if (point.alive && !point.observations.empty())
        result.points.push_back({point.id, carried(point)});
    }
  }

  [[nodiscard]] ImagingEstimate estimate_imaging() const {
    ImagingEstimator estimator(poses_.size());
    std::vector<ObservationDerivatives> of_point;
    for (const auto& point : scene_.points()) {
      if (!is_adjusted(point)) continue;
      of_point.clear();
      for (const auto& o : point.observations) of_point.push_back(derivatives(o, point.position));
      estimator.add_point(of_point);
    }
    return estimator.estimate({scene_.job().readout_s, scene_.job().focal_scale});
  }

 private:
  /// A point that only one keyframe sees would just take that keyframe's measurement: it is carried along.
  static bool is_adjusted(const MappingScene::ScenePoint& point) {
    return point.alive && point.observations.size() >= 2;
  }

  void optimize_dense(const BundleOptions& bundle, bool robust) {
    ceres::Problem::Options ownership;
    ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(ownership);
    auto* ordering = new ceres::ParameterBlockOrdering;
    for (auto& point : scene_.points()) {
      if (!is_adjusted(point)) continue;
      for (const auto& o : point.observations) {
        const Measurement m = measurement(o);
        ceres::LossFunction* loss = !robust ? nullptr : m.disparity_weight > 0 ? &huber_3d_ : &huber_2d_;
        problem.AddResidualBlock(new ReprojectionCost(cost(o)), loss, poses_[o.keyframe].data(),
                                 point.position.data());
      }
      ordering->AddElementToGroup(point.position.data(), 0);
    }
    for (std::size_t k = 0; k < poses_.size(); ++k) {
      if (!problem.HasParameterBlock(poses_[k].data())) continue;
      problem.SetManifold(poses_[k].data(), &manifold_);
      if (scene_.job().keyframes[k].fixed) problem.SetParameterBlockConstant(poses_[k].data());
      ordering->AddElementToGroup(poses_[k].data(), 1);
    }
    ceres::Solver::Options options = solver_options(bundle);
    options.linear_solver_ordering.reset(ordering);
    StopCallback stop(bundle.stop);
    options.callbacks.push_back(&stop);
    ceres::Solver::Summary summary;
    if (problem.NumResidualBlocks() > 0) ceres::Solve(options, &problem, &summary);
  }

  void optimize_sparse(const BundleOptions& options, bool robust) {
    Bundle bundle;
    const auto& keyframes = scene_.job().keyframes;
    for (std::size_t k = 0; k < poses_.size(); ++k)
      bundle.cameras.push_back({to_pose(poses_[k].data()), models_[k], keyframes[k].fixed});
    for (const auto& point : scene_.points()) {
      if (!is_adjusted(point)) continue;
      BundlePoint& adjusted = bundle.points.emplace_back(BundlePoint{point.position, {}});
      for (const auto& o : point.observations)
        adjusted.observations.push_back({o.keyframe, measurement(o), shift(o)});
    }
    solve_bundle(bundle, {options.iterations, robust, options.stop});
    for (std::size_t k = 0; k < poses_.size(); ++k) poses_[k] = to_block(bundle.cameras[k].camera_from_map);
    auto adjusted = bundle.points.begin();
    for (auto& point : scene_.points())
      if (is_adjusted(point)) point.position = (adjusted++)->position;
  }

  /// Removes the observations that are not good.
  template <class Good>
  void keep(LocalMappingResult& result, const Good& good) {
    for (auto& point : scene_.points()) {
      if (!is_adjusted(point)) continue;
      std::erase_if(point.observations, [&](const MappingScene::SceneObservation& o) {
        if (good(o, point.position)) return false;
        result.removed.push_back({point.id, scene_.job().keyframes[o.keyframe].id, o.feature});
        return true;
      });
    }
  }

  [[nodiscard]] Eigen::Vector3d in_camera(const MappingScene::SceneObservation& o,
                                          const Eigen::Vector3d& map_point) const {
    return to_pose(poses_[o.keyframe].data()) * map_point;
  }

  [[nodiscard]] Eigen::Vector3d carried(const MappingScene::ScenePoint& point) const {
    const std::size_t k = point.observations.front().keyframe;
    return to_pose(poses_[k].data()).inverse() *
           (scene_.job().keyframes[k].map_from_camera.inverse() * point.position);
  }

  [[nodiscard]] Measurement measurement(const MappingScene::SceneObservation& o) const {
    return models_[o.keyframe].measurement((*scene_.job().keyframes[o.keyframe].features)[o.feature],
                                           scene_.job().pyramid);
  }

  /// Derivative of the weighted residual by the readout time, 1/s. The residual is predicted − measured, and
  /// measured − readout·effect is what the pose predicts.
  [[nodiscard]] Eigen::Vector3d by_readout(const MappingScene::SceneObservation& o) const {
    const MappingKeyframe& k = scene_.job().keyframes[o.keyframe];
    const geometry::CameraModel& camera = k.features->camera();
    const Eigen::Vector3d effect = shutter_effect(camera, k.motion.velocity, (*k.features)[o.feature]);
    if (effect.isZero(0)) return Eigen::Vector3d::Zero();
    return models_[o.keyframe].jacobian(k.features->point_in_camera(o.feature), measurement(o)) * effect;
  }

  /// What a feature was compensated for is made good with the readout time that is known by now.
  [[nodiscard]] Eigen::Vector3d shift(const MappingScene::SceneObservation& o) const {
    const double late = scene_.job().readout_s - scene_.job().keyframes[o.keyframe].motion.readout_s;
    return late * by_readout(o);
  }

  [[nodiscard]] ReprojectionCost cost(const MappingScene::SceneObservation& o) const {
    return {models_[o.keyframe], measurement(o), shift(o)};
  }

  [[nodiscard]] ObservationDerivatives derivatives(const MappingScene::SceneObservation& o,
                                                   const Eigen::Vector3d& position) const {
    ObservationDerivatives d;
    Eigen::Matrix<double, 3, 7, Eigen::RowMajor> by_pose;
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> by_point;
    const std::array parameters{poses_[o.keyframe].data(), position.data()};
    std::array jacobians{by_pose.data(), by_point.data()};
    cost(o).Evaluate(parameters.data(), d.residual.data(), jacobians.data());
    const Eigen::Vector3d p = in_camera(o, position);
    d.camera = o.keyframe;
    d.by_pose = by_pose.leftCols<6>();
    d.by_point = by_point;
    d.by_imaging.col(0) = by_readout(o);
    if (is_calibrated(scene_.job().keyframes[o.keyframe], scene_.job()))
      d.by_imaging.col(1) = models_[o.keyframe].by_focal_scale(p, measurement(o)) / scene_.job().focal_scale;
    return d;
  }

  MappingScene& scene_;
  std::vector<PoseBlock> poses_;  // per keyframe
  std::vector<ObservationModel> models_;
  PoseManifold manifold_;
  ceres::HuberLoss huber_2d_{std::sqrt(kChi2Pixel)};
  ceres::HuberLoss huber_3d_{std::sqrt(kChi2PixelAndDisparity)};
};

}  // namespace

ImagingEstimate adjust_bundle(MappingScene& scene, const BundleOptions& options, LocalMappingResult& result) {
  Adjuster bundle(scene);
  bundle.remove_impossible(result);
  bundle.optimize(options, true);
  if (options.stop.stop_requested()) return {};
  bundle.remove_outliers(result);
  bundle.optimize(options, false);
  if (options.stop.stop_requested()) return {};
  bundle.report(result);
  return options.is_sparse ? ImagingEstimate{} : bundle.estimate_imaging();
}

}  // namespace rds::tracker
