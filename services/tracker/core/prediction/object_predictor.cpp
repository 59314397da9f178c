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

std::unique_ptr<ObjectTracking> make_tracking(const PredictionConfig& config) {
  if (config.algorithm == "paper") return std::make_unique<PlaneTracking>(config.paper);
  if (config.algorithm == "kalman3d") return std::make_unique<KalmanTracking>(config.kalman3d);
  throw std::invalid_argument("prediction.algorithm: " + config.algorithm + ", expected paper or kalman3d");
}

}  // namespace

ObjectPredictor::ObjectPredictor(PredictionConfig config)
    : config_(std::move(config)), tracking_(make_tracking(config_)) {}

bool ObjectPredictor::update(std::int64_t stamp_ns, std::span<const ObjectObservation> observations,
                             const std::optional<KeyframeView>& view) {
  if (latest_ns_ && stamp_ns <= *latest_ns_) return false;
  const ObservationLimits limits{config_.min_score, config_.duplicate_overlap, kMaxObservations};
  auto used = usable(observations, limits);
  if (view) {
    std::erase_if(used, [&](const ObjectObservation& o) { return is_doubtful(o, *view, config_); });
    const geometry::Pose camera_from_map = view->map_from_camera.inverse();
    for (ObjectObservation& o : used)
      o.cut = cut_sides(o.box, camera_from_map, view->camera, config_.border_px);
  }
  tracking_->update(stamp_ns, used, view ? &*view : nullptr);
  latest_ns_ = stamp_ns;
  return true;
}

std::vector<PredictedObject> ObjectPredictor::predict(std::int64_t stamp_ns) const {
  if (!latest_ns_) return {};
  auto objects = tracking_->predict(std::max(stamp_ns, *latest_ns_));
  for (PredictedObject& object : objects) object.movable = is_movable(config_, object.label);
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
