// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

#include "services/tracker/core/mapping/local_mapping.hpp"

namespace rds::tracker {

/// The working copy of a local mapping job: who sees what, while observations are added and points fused.
class MappingScene {
 public:
  struct SceneObservation {
    std::size_t keyframe = 0;  // index into job.keyframes
    std::uint32_t feature = 0;
  };
  struct ScenePoint {
    PointId id = kNoId;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    std::vector<SceneObservation> observations;
    bool alive = true;
  };

  explicit MappingScene(const LocalMappingJob& job);

  [[nodiscard]] const LocalMappingJob& job() const { return job_; }
  [[nodiscard]] std::vector<ScenePoint>& points() { return points_; }
  [[nodiscard]] const std::vector<ScenePoint>& points() const { return points_; }
  [[nodiscard]] std::optional<std::size_t> index_of(PointId id) const;
  [[nodiscard]] std::optional<std::size_t> keyframe_index(KeyframeId id) const;
  [[nodiscard]] bool sees(std::size_t keyframe, std::size_t point) const;
  /// Per keyframe of the job and feature: the point it sees; kNoId.
  [[nodiscard]] const std::vector<std::vector<PointId>>& seen() const { return features_; }

  /// Lets a feature see a point; if it sees another one the two are fused into the one observed more often.
  void connect(std::size_t point, std::size_t keyframe, std::uint32_t feature, LocalMappingResult& result);

 private:
  void fuse(std::size_t a, std::size_t b, LocalMappingResult& result);

  const LocalMappingJob& job_;
  std::vector<ScenePoint> points_;              // as job.points
  std::vector<std::vector<PointId>> features_;  // per keyframe and feature: the point it sees
};

/// True for a keyframe of the camera whose focal length the job knows.
bool is_calibrated(const MappingKeyframe& keyframe, const LocalMappingJob& job);
/// The camera of a keyframe with the focal length that is known by now; another camera stays as it is.
geometry::CameraModel known_camera(const MappingKeyframe& keyframe, const LocalMappingJob& job);

/// Looks for the centre's points in the other keyframes and for theirs in the centre.
/// Source: Mur-Artal et al. 2015, §VI-C.
void search_and_fuse(MappingScene& scene, LocalMappingResult& result);

struct BundleOptions {
  int iterations = kBundleIterations;  // of each of the two passes
  bool is_sparse = false;              // of many keyframes few see the same points
  std::stop_token stop;                // gives up after the present iteration
};

/// Moves free keyframes and points so that the points show where their features are; observations that
/// disagree are removed.
/// @return what was learned of the camera; nothing in a sparse scene, or if it was stopped: then the result
/// is of no use.
ImagingEstimate adjust_bundle(MappingScene& scene, const BundleOptions& options, LocalMappingResult& result);

}  // namespace rds::tracker
