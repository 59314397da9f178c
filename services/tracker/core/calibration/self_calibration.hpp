// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "common/geometry/camera_model.hpp"
#include "services/tracker/core/config/tracker_config.hpp"

namespace rds::tracker {

/// What a camera does not tell about itself, in this order: readout time [s], focal length as a factor on the
/// given one [1].
using Imaging = Eigen::Vector2d;

/// What one bundle says about the imaging.
struct ImagingEstimate {
  Imaging value = Imaging::Zero();
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  // inverse covariance, everything else being unknown
};

/// How one observation's weighted residual changes.
struct ObservationDerivatives {
  std::size_t camera = 0;
  Eigen::Vector3d residual;
  Eigen::Matrix<double, 3, 6> by_pose;
  Eigen::Matrix3d by_point;
  Eigen::Matrix<double, 3, 2> by_imaging = Eigen::Matrix<double, 3, 2>::Zero();
};

/// One Gauss-Newton step of a bundle in which points, poses and imaging are free, for the imaging alone.
///
/// Camera 0 is the gauge, all others are free: fixed keyframes would only confirm the imaging that the map
/// was built with. Poses and points are not moved. Source: Triggs et al. 2000, §6.1 (Schur complement).
class ImagingEstimator {
 public:
  explicit ImagingEstimator(std::size_t cameras);

  /// @param observations  of one point, each by another camera.
  void add_point(std::span<const ObservationDerivatives> observations);
  /// @param at  where the derivatives were taken. @return its value and no information if nothing is known.
  [[nodiscard]] ImagingEstimate estimate(const Imaging& at) const;

 private:
  Eigen::MatrixXd normal_;    // of imaging and poses, points eliminated
  Eigen::VectorXd gradient_;  // likewise
};

/// What tells a camera again, and what was found out about it.
struct KnownCamera {
  double given_fx = 0;  // px; 0: none was seen
  double focal_scale = 1;
};

/// What was found out about the imaging so far.
struct ImagingBelief {
  Imaging value = Imaging(0, 1);
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  bool readout_is_wrong = false;  // as it was given
  bool focal_is_wrong = false;
  int focal_bundles = 0;  // in which the focal length was believed
};

/// What is known of the camera's imaging: the mean of what bundles found, weighted with how much they could
/// tell and with older ones slowly forgotten.
class SelfCalibration {
 public:
  explicit SelfCalibration(const SelfCalibrationConfig& config);

  /// The camera with the focal length that is known by now. Another given one is another camera, of which
  /// nothing is known.
  [[nodiscard]] geometry::CameraModel calibrated(const geometry::CameraModel& given);
  /// Focal length that the camera came with [px]; 0 before the first picture.
  [[nodiscard]] double given_fx() const { return given_fx_; }
  [[nodiscard]] KnownCamera known_camera() const { return {given_fx_, focal_scale()}; }
  /// The given readout time until it is known to be wrong.
  [[nodiscard]] double readout_s() const {
    return belief_.readout_is_wrong ? belief_.value(0) : config_.readout_s;
  }
  /// Factor on the given focal length: 1 until that is known to be wrong.
  [[nodiscard]] double focal_scale() const { return belief_.focal_is_wrong ? belief_.value(1) : 1; }
  /// Goes on from what was known when a map was saved; a focal length by which no camera can be off is
  /// ignored.
  void begin_with(const KnownCamera& camera);
  /// Goes on from what another one believed.
  void begin_with(double given_fx, const ImagingBelief& belief);
  [[nodiscard]] const ImagingBelief& belief() const { return belief_; }
  /// A bundle that knows the focal length badly, or claims an impossible one, tells the readout time only.
  void update(const ImagingEstimate& estimate);
  /// The same with the bundle around a keyframe, once for each: older keyframes than the newest are ignored.
  void update(std::uint64_t keyframe, const ImagingEstimate& estimate);

 private:
  SelfCalibrationConfig config_;
  ImagingBelief belief_;
  double given_fx_ = 0;
  std::optional<std::uint64_t> newest_keyframe_;  // that was learned from
};

}  // namespace rds::tracker
