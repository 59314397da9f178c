// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/kalman_tracking.hpp"

#include <algorithm>

#include "services/tracker/core/prediction/observation_filter.hpp"
#include "services/tracker/core/prediction/sort/assignment.hpp"
#include "services/tracker/core/prediction/visibility.hpp"

namespace rds::tracker::prediction {
namespace {

constexpr double kForbidden = 1e3;     // more than any sum of real costs can save
constexpr double kMaxDistanceM = 0.6;  // an observation farther from the prediction starts a new object, …
constexpr double kGateSigma = 3.5;     // … and so does one that is more improbable
constexpr int kMaxMisses = 2;          // keyframes that should have shown an object, then it is forgotten …
constexpr double kMaxAgeS = 1.5;       // … and so is one that has not been seen for longer
constexpr double kGrowthSigma = 0.3;   // standard deviations of the centre that a box grows per side

/// The box with its sides moved outwards by a share of the centre's standard deviation.
geometry::OrientedBox grown(const ObjectFilter& filter) {
  geometry::OrientedBox box = filter.box();
  const Eigen::Array3d growth =
      (kGrowthSigma * filter.center_sigma_in_box().array()).min(KalmanTracking::kMaxGrowthM);
  box.size.array() += 2 * growth;
  return box;
}

}  // namespace

void KalmanTracking::update(std::int64_t stamp_ns, std::span<const ObjectObservation> observations,
                            const KeyframeView* view) {
  move_to(stamp_ns);
  const auto track_of = match(observations);
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const ObjectObservation& observation = observations[i];
    if (track_of[i] < 0) {
      tracks_.push_back({++last_id_, observation.label, observation.score, stamp_ns, 0,
                         ObjectFilter(observation.box, observation.cut)});
      continue;
    }
    Track& track = tracks_[static_cast<std::size_t>(track_of[i])];
    track.filter.correct(observation.box, observation.cut);
    track.score = observation.score;
    track.seen_ns = stamp_ns;
    track.misses = 0;
  }
  count_misses(observations, view);
}

void KalmanTracking::count_misses(std::span<const ObjectObservation> observations, const KeyframeView* view) {
  for (Track& track : tracks_) {
    const bool missed = track.seen_ns < state_ns_ &&
                        (view == nullptr || should_be_detected(track.filter.box(), observations, *view));
    if (missed) ++track.misses;
  }
  std::erase_if(tracks_, [](const Track& track) { return track.misses > kMaxMisses; });
}

void KalmanTracking::move_map(const geometry::Pose& new_from_old) {
  for (Track& track : tracks_) track.filter.move_map(new_from_old);
}

void KalmanTracking::move_to(std::int64_t stamp_ns) {
  std::erase_if(tracks_,
                [&](const Track& track) { return seconds_between(track.seen_ns, stamp_ns) > kMaxAgeS; });
  for (Track& track : tracks_) track.filter.predict(seconds_between(state_ns_, stamp_ns));
  state_ns_ = stamp_ns;
}

std::vector<std::ptrdiff_t> KalmanTracking::match(std::span<const ObjectObservation> observations) const {
  std::vector<std::ptrdiff_t> track_of(observations.size(), -1);
  Eigen::MatrixXd costs(observations.size(), tracks_.size());
  for (Eigen::Index i = 0; i < costs.rows(); ++i)
    for (Eigen::Index j = 0; j < costs.cols(); ++j)
      costs(i, j) = cost(tracks_[static_cast<std::size_t>(j)], observations[static_cast<std::size_t>(i)])
                        .value_or(kForbidden);
  const auto column_of = assign(costs);
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (column_of[i] && costs(static_cast<Eigen::Index>(i), *column_of[i]) < kForbidden)
      track_of[i] = *column_of[i];
  return track_of;
}

std::optional<double> KalmanTracking::cost(const Track& track, const ObjectObservation& observation) {
  if (track.label != observation.label) return std::nullopt;
  const double distance = (track.filter.center() - observation.box.center()).norm();
  if (distance > kMaxDistanceM) return std::nullopt;
  if (track.filter.mahalanobis(observation.box, observation.cut) > kGateSigma) return std::nullopt;
  return distance / kMaxDistanceM + 1 - overlap_of_smaller(observation.box, track.filter.box());
}

std::vector<PredictedObject> KalmanTracking::predict(std::int64_t stamp_ns) const {
  std::vector<PredictedObject> objects;
  for (const Track& track : tracks_)
    if (seconds_between(track.seen_ns, stamp_ns) <= kMaxAgeS) objects.push_back(describe(track, stamp_ns));
  return objects;
}

PredictedObject KalmanTracking::describe(const Track& track, std::int64_t stamp_ns) const {
  ObjectFilter filter = track.filter;
  filter.predict(seconds_between(state_ns_, stamp_ns));
  PredictedObject object;
  object.id = track.id;
  object.label = track.label;
  object.score = track.score;
  object.box = grown(filter);
  object.velocity = filter.velocity();
  object.covariance_trace = filter.center_covariance().trace();
  object.age_s = seconds_between(track.seen_ns, stamp_ns);
  return object;
}

}  // namespace rds::tracker::prediction
