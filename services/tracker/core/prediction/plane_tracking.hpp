// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "common/geometry/box.hpp"
#include "services/tracker/core/prediction/object_tracking.hpp"
#include "services/tracker/core/prediction/sort/sort.hpp"

namespace rds::tracker::prediction {

/// The paper's Algorithm 1: SORT in the coordinate planes xOy, yOz and zOx of the map, recombined by IoU.
///
/// Plane p has the axes (p, p + 1) modulo 3, so that the planes (m, m + 1, m + 2) are (ab, bc, ca) whichever
/// plane m is the largest. Boxes are scaled so that SORT's pixel noise fits.
/// Deviations, where the paper is silent:
/// - line 1: what is mapped is the hull of the box with its thickness; the two corner points alone have no
///   extent in a plane that the viewing direction lies in. The corners follow their hull (see predict()).
/// - line 7: "max matrix" is the plane with most tracks; of equal ones the first of xOy, yOz, zOx.
/// - line 15: without any overlap, c is that of the track's own latest detection.
/// - identities: SORT numbers each plane by itself; the object's id is that of the track in plane ab, which
/// the
///   planes agree on through the detections that their tracks matched.
/// - SORT's own time step is one frame; here it is the real one.
class PlaneTracking : public ObjectTracking {
 public:
  PlaneTracking();

  void update(std::int64_t stamp_ns, std::span<const ObjectObservation> observations,
              const KeyframeView* view) override;
  [[nodiscard]] std::vector<PredictedObject> predict(std::int64_t stamp_ns) const override;
  void move_map(const geometry::Pose& /*new_from_old*/) override { reset(); }
  void reset() override;

 private:
  /// What a track's latest detection was: "the information of latest frame" of line 8.
  struct Latest {
    ObjectObservation observation;
    geometry::Box3 hull;
    std::uint64_t object_id = 0;
    std::int64_t stamp_ns = 0;
  };
  struct Plane {
    Sort sort;
    std::map<std::uint64_t, Latest> latest;  // by the track's id
  };
  /// A track of one plane at the asked time.
  struct Prediction {
    geometry::Box2 box;        // [m] along the plane's two axes
    Eigen::Vector2d velocity;  // [m/s]
    Eigen::Vector2d variance;  // of the centre [m²]
    const Latest* latest = nullptr;
  };

  using Predictions = std::array<std::vector<Prediction>, 3>;  // by plane
  /// Extent of an object along the axis that plane ab does not have.
  struct Depth {
    double low = 0;   // [m]
    double high = 0;  // [m]
    double velocity = 0;
    double variance = 0;
  };

  /// The object that an observation continues, known from its tracks in the planes; a new id if none.
  std::uint64_t object_of(const std::array<std::uint64_t, 3>& tracks, std::span<const std::uint64_t> taken);
  [[nodiscard]] std::vector<Prediction> predict_plane(std::size_t plane, double frames) const;
  static Depth third_axis(const Prediction& ab, std::size_t largest, const Predictions& predicted);
  static PredictedObject recombine(const Prediction& ab, std::size_t largest, const Predictions& predicted);

  std::array<Plane, 3> planes_;
  std::int64_t state_ns_ = 0;
  std::uint64_t last_object_id_ = 0;
};

}  // namespace rds::tracker::prediction
