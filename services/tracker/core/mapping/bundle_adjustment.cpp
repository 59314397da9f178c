// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "services/tracker/core/adjustment/bundle_solver.hpp"
#include "services/tracker/core/mapping/ceres_bundle.hpp"
#include "services/tracker/core/mapping/mapping_scene.hpp"

namespace rds::tracker {
namespace {

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
    ceres::Solver::Options options = solver_options(bundle.iterations);
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
