// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/object_predictor.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "services/tracker/core/prediction/image_projection.hpp"
#include "services/tracker/core/prediction/kalman_tracking.hpp"
#include "services/tracker/core/prediction/observation_filter.hpp"
#include "services/tracker/core/prediction/plane_tracking.hpp"
#include "services/tracker/core/prediction/visibility.hpp"

namespace rds::tracker::prediction {
namespace {

constexpr double kDuplicateOverlap = 0.7;  // share of the smaller box: two boxes of one object
constexpr double kBorderPx = 6;            // a box that ends this near to the picture's edge is cut off by it

std::unique_ptr<ObjectTracking> make_tracking(const PredictionConfig& config) {
  if (config.algorithm == "paper") return std::make_unique<PlaneTracking>();
  if (config.algorithm == "kalman3d") return std::make_unique<KalmanTracking>();
  throw std::invalid_argument("prediction.algorithm: " + config.algorithm + ", expected paper or kalman3d");
}

}  // namespace

ObjectPredictor::ObjectPredictor(PredictionConfig config)
    : config_(std::move(config)), tracking_(make_tracking(config_)) {}

bool ObjectPredictor::update(std::int64_t stamp_ns, std::span<const ObjectObservation> observations,
                             const std::optional<KeyframeView>& view) {
  if (latest_ns_ && stamp_ns <= *latest_ns_) return false;
  const ObservationLimits limits{config_.min_score, kDuplicateOverlap, kMaxObservations};
  auto used = usable(observations, limits);
  if (view) {
    std::erase_if(used, [&](const ObjectObservation& o) { return is_implausible(o, *view); });
    const geometry::Pose camera_from_map = view->map_from_camera.inverse();
    for (ObjectObservation& o : used) o.cut = cut_sides(o.box, camera_from_map, view->camera, kBorderPx);
  }
  tracking_->update(stamp_ns, used, view ? &*view : nullptr);
  latest_ns_ = stamp_ns;
  return true;
}

std::vector<PredictedObject> ObjectPredictor::predict(std::int64_t stamp_ns) const {
  if (!latest_ns_) return {};
  auto objects = tracking_->predict(std::max(stamp_ns, *latest_ns_));
  for (PredictedObject& object : objects) object.movable = config_.labels[object.label].movable;
  return objects;
}

void ObjectPredictor::move_map(const geometry::Pose& new_from_old) {
  if (geometry::is_finite(new_from_old)) tracking_->move_map(new_from_old);
}

void ObjectPredictor::reset() {
  tracking_->reset();
  latest_ns_.reset();
}

}  // namespace rds::tracker::prediction
