// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/loop_closer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rds::loop_closer {
namespace {

using geometry::Pose;

constexpr std::size_t kMaxFeatures = 100'000;  // of a message that can be meant
constexpr float kMinDepth = 0.1F;
constexpr double kMaxPosition = 1e6;  // [m]

// Candidates.
constexpr std::size_t kMinGap = 10;        // keyframes; nearer ones are neighbours, which local mapping joins
constexpr double kMinScore = 0.02;         // of the place index; another room reaches .02
constexpr std::size_t kMaxCandidates = 5;  // verified per keyframe
constexpr std::size_t kMinSeparation = 5;  // keyframes between two candidates: different views

constexpr std::size_t kPatience = 20;  // keyframes until a tracker has followed a loop, if it does

// Drift that is believable after `path` metres of travel: kMaxDriftFloorM + kMaxDriftShare · path, and
// kMaxDriftRad. Many times what the tracker's drift is; two rooms that look alike are farther apart.
constexpr double kMaxDriftShare = 0.3;
constexpr double kMaxDriftFloorM = 0.3;
constexpr double kMaxDriftRad = 0.8;

bool is_rigid(const Pose& pose) {
  return geometry::is_finite(pose) && pose.translation().norm() < kMaxPosition &&
         (pose.linear() * pose.linear().transpose()).isIdentity(1e-3) && pose.linear().determinant() > 0;
}

/// The features that are static and have a depth, at most `max_features`.
KeyframeView view_of(const KeyframeFeatures& features, int max_features, double max_depth_m) {
  KeyframeView view;
  view.descriptors.reserve(static_cast<std::size_t>(std::min<int>(max_features, features.descriptors.rows)));
  for (std::size_t i = 0; i < features.points.size(); ++i) {
    if (static_cast<int>(view.points.size()) == max_features) break;
    const Eigen::Vector3f& point = features.points[i];
    if (!features.movable.empty() && features.movable[i] != 0) continue;
    if (!point.allFinite() || point.z() < kMinDepth || static_cast<double>(point.z()) > max_depth_m) continue;
    if (point.head<2>().norm() > 5 * point.z()) continue;  // no camera of ours sees so far aside
    view.points.push_back(point.cast<double>());
    view.descriptors.push_back(features.descriptors.row(static_cast<int>(i)));
  }
  return view;
}

}  // namespace

LoopCloser::LoopCloser(const LoopCloserConfig& config) : config_(config) {}

void LoopCloser::reset() {
  const auto start = std::move(start_);
  *this = LoopCloser(config_);
  start_ = start;
  if (!start_) return;
  graph_.hold(start_->poses);
  views_ = start_->views;
  for (std::size_t i = 0; i < views_.size(); ++i) index_.add(start_->poses[i].id, views_[i].descriptors);
}

std::string LoopCloser::why_impossible(const KeyframeFeatures& f) const {
  const auto rows = static_cast<std::size_t>(f.descriptors.rows);
  if (rows > kMaxFeatures) return "more than 100000 features";
  if (!f.descriptors.empty() && (f.descriptors.type() != CV_8UC1 || f.descriptors.cols != 32))
    return "descriptors are not N×32 bytes";
  if (f.points.size() != rows) return "points and descriptors differ in number";
  if (!f.movable.empty() && f.movable.size() != rows) return "movable flags and descriptors differ in number";
  const auto rigid = [](const Covisible& c) { return is_rigid(c.map_from_camera); };
  if (!is_rigid(f.map_from_camera) || !std::all_of(f.covisible.begin(), f.covisible.end(), rigid))
    return "a pose is not a finite rigid transform";
  if (map_epoch_ == f.map_epoch && graph_.size() > 0 && f.id <= graph_.id(graph_.size() - 1))
    return "keyframe id does not count up";
  return {};
}

LoopAnswer LoopCloser::add(const KeyframeFeatures& features) {
  LoopAnswer answer;
  answer.map_epoch = features.map_epoch;
  answer.keyframe_id = features.id;
  answer.refused = why_impossible(features);
  if (answer.refused.empty()) {
    if (map_epoch_ && map_epoch_ != features.map_epoch) reset();
    map_epoch_ = features.map_epoch;
    const std::size_t query = graph_.size();
    graph_.add({features.id, features.stamp_ns, features.map_from_camera}, features.covisible,
               follows(query, features));
    views_.push_back(view_of(features, config_.max_features, config_.max_depth_m));
    answer.loops = close_loop(query, features);
    if (!answer.loops.empty()) {
      ++revision_;
      unconfirmed_since_ = query;
      answer.poses = graph_.poses();
    }
    index_.add(features.id, views_[query].descriptors);
  }
  answer.revision = revision_;
  answer.loops_closed = static_cast<std::uint32_t>(revision_);
  return answer;
}

/// Whether the tracker's poses are as the graph has them. One that has not followed a correction for long has
/// refused it.
bool LoopCloser::follows(std::size_t query, const KeyframeFeatures& features) {
  if (!unconfirmed_since_) return true;
  const bool is_refused = !features.follows && *unconfirmed_since_ + kPatience < query;
  if (is_refused) graph_.take_back();
  if (is_refused || features.follows) unconfirmed_since_.reset();
  return !unconfirmed_since_;
}

std::vector<std::size_t> LoopCloser::candidates_for(std::size_t query,
                                                    const KeyframeFeatures& features) const {
  std::vector<std::size_t> chosen;
  for (const auto& found : index_.query(views_[query].descriptors, graph_.size())) {
    if (found.score < kMinScore || chosen.size() == kMaxCandidates) break;
    const auto candidate = graph_.find(found.id);
    if (!candidate || *candidate + kMinGap > query) continue;
    const auto is_found = [&](const Covisible& other) { return other.id == found.id && other.weight > 0; };
    if (std::any_of(features.covisible.begin(), features.covisible.end(), is_found)) continue;
    const auto is_near = [&](std::size_t other) {
      return std::max(other, *candidate) - std::min(other, *candidate) < kMinSeparation;
    };
    if (std::none_of(chosen.begin(), chosen.end(), is_near)) chosen.push_back(*candidate);
  }
  return chosen;
}

std::optional<LoopDetection> LoopCloser::detect(std::size_t query, std::size_t candidate) const {
  const auto verified = verify_loop(views_[query], views_[candidate]);
  if (!verified) return std::nullopt;
  const Pose& estimated = graph_.map_from_camera(query);
  const Pose measured = graph_.map_from_camera(candidate) * verified->candidate_from_query;
  return LoopDetection{query, candidate, verified->candidate_from_query, measured * estimated.inverse(),
                       estimated.translation()};
}

/// Not larger than drift can be.
bool LoopCloser::is_believable(const LoopDetection& detection) const {
  const double moved_m = (detection.correction * detection.query_in_map - detection.query_in_map).norm();
  const double turned_rad = geometry::rotation_angle_rad(detection.correction.linear());
  const double path_m = graph_.path_length(detection.candidate, detection.query);
  return moved_m <= kMaxDriftFloorM + kMaxDriftShare * path_m && turned_rad <= kMaxDriftRad;
}

std::vector<LoopMatch> LoopCloser::close_loop(std::size_t query, const KeyframeFeatures& features) {
  if (unconfirmed_since_) return {};  // the tracker is about to move everything
  std::vector<LoopDetection> detections;
  for (const std::size_t candidate : candidates_for(query, features)) {
    const auto detection = detect(query, candidate);
    if (detection && is_believable(*detection)) detections.push_back(*detection);
  }
  std::vector<PoseGraphEdge> loops;
  std::vector<LoopMatch> matches;
  for (const LoopDetection& d : most_that_agree(detections)) {
    loops.push_back({d.candidate, d.query, d.candidate_from_query, EdgeKind::kLoop});
    matches.push_back({graph_.id(d.query), graph_.id(d.candidate), d.candidate_from_query});
  }
  if (loops.empty() || !graph_.close(loops)) return {};
  return matches;
}

}  // namespace rds::loop_closer
