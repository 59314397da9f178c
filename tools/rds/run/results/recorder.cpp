// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/results/recorder.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "common/messages/conversions.hpp"
#include "common/messages/detection_conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"
#include "common/messages/keyframe_pose_table.hpp"
#include "common/topics/endpoints.hpp"

namespace rds::run {
namespace {

std::string state_name(std::uint8_t state) {
  static const std::array<std::string, 6> kNames{"NOT_INITIALIZED", "TRACKING", "WEAK", "LOST",
                                                 "RELOCALISED",     "SUBMAP"};
  return state < kNames.size() ? kNames[state] : "UNKNOWN";
}

bool state_has_pose(std::uint8_t state) {
  return state == 1 || state == 2 || state == 4;
}

FrameRecord to_record(const rds_msgs::msg::TrackingState& m) {
  const auto ms = [](std::uint32_t us) { return us / 1000.0; };
  return {.stamp_ns = messages::to_nanoseconds(m.header().stamp()),
          .state = state_name(m.state()),
          .has_pose = state_has_pose(m.state()),
          .is_in_submap = m.state() == rds_msgs::msg::TrackingState_Constants::SUBMAP,
          .is_keyframe = m.is_keyframe(),
          .features = m.features(),
          .dynamic_features = m.dynamic_features(),
          .inliers = m.inliers(),
          .extract_ms = ms(m.extract_us()),
          .predict_ms = ms(m.predict_us()),
          .track_ms = ms(m.track_us()),
          .total_ms = ms(m.total_us()),
          .reference_keyframe_id = m.reference_keyframe_id(),
          .map_from_camera = messages::to_pose(m.map_from_camera()).value_or(geometry::Pose::Identity()),
          .reference_from_camera =
              messages::to_pose(m.reference_from_camera()).value_or(geometry::Pose::Identity()),
          .map_epoch = m.map_epoch()};
}

Eigen::Vector3d vector_at(const std::vector<double>& flat, std::size_t i) {
  return {flat.at(3 * i), flat.at(3 * i + 1), flat.at(3 * i + 2)};
}

std::vector<PredictionRecord> to_records(const rds_msgs::msg::PredictedBoxes& m) {
  std::vector<PredictionRecord> records;
  for (std::size_t i = 0; i < m.ids().size(); ++i) {
    const auto& b = m.boxes();
    records.push_back({.id = m.ids()[i],
                       .label = m.labels().at(i),
                       .box = {b.at(4 * i), b.at(4 * i + 1), b.at(4 * i + 2), b.at(4 * i + 3)},
                       .volume = {vector_at(m.minimums(), i), vector_at(m.maximums(), i)},
                       .velocity = vector_at(m.velocities(), i),
                       .age_s = m.ages().at(i)});
  }
  return records;
}

}  // namespace

Recorder::Recorder(bus::Participant& bus) : tracker_(bus, service::kTracker) {
  subscribe(bus, topics::kTrackingState, &Recorder::on_state);
  subscribe(bus, topics::kPredictedBoxes, &Recorder::on_boxes);
  subscribe(bus, topics::kKeyframePoses, &Recorder::on_poses);
  subscriptions_.push_back(topics::subscribe(bus, topics::kDetections, topics::kPlayer,
                                             [this](const auto& m) { on_detections(*m); }));
  subscribe(bus, topics::kMapInfo, &Recorder::on_map_info);
}

template <class Message>
void Recorder::subscribe(bus::Participant& bus, const topics::Topic<Message>& topic,
                         void (Recorder::*take)(const Message&)) {
  subscriptions_.push_back(
      topics::subscribe(bus, topic, topics::kPlayer,
                        owners_.only_owned([this, take](const auto& m) { (this->*take)(*m); }, [] {})));
}

void Recorder::on_state(const rds_msgs::msg::TrackingState& message) {
  const FrameRecord record = to_record(message);
  {
    const std::lock_guard lock(mutex_);
    if (!tracker_.accept(message.instance(), message.map_epoch() == epoch_)) return;
    if (message.map_epoch() != epoch_) {  // a tracker that was restarted: its keyframes count anew
      epoch_ = message.map_epoch();
      keyframes_ = 0;
      last_mapped_id_.reset();
      unmapped_.clear();
    }
    recording_.frames[record.stamp_ns] = record;
    recording_.frames_dropped = message.frames_dropped();
    if (message.is_keyframe() && !record.is_in_submap) {  // of a submap none reaches the map yet
      if (keyframes_ == 0) first_keyframe_id_ = message.keyframe_id();
      keyframes_ = message.keyframe_id() + 1 - first_keyframe_id_;
      unmapped_.emplace(message.keyframe_id(), Clock::now());
    }
  }
  changed_.notify_all();
}

void Recorder::on_boxes(const rds_msgs::msg::PredictedBoxes& message) {
  std::vector<PredictionRecord> records;
  try {
    records = to_records(message);
  } catch (const std::out_of_range&) {
    return;  // somebody else's message: arrays of different lengths
  }
  {
    const std::lock_guard lock(mutex_);
    if (!tracker_.accept(message.instance(), message.map_epoch() == epoch_)) return;
    recording_.predictions[messages::to_nanoseconds(message.header().stamp())] = std::move(records);
  }
  changed_.notify_all();
}

/// Each correction once: it is repeated in the answers to the keyframes after it.
void Recorder::on_loops(const rds_msgs::msg::KeyFramePoses& message) {
  const std::lock_guard lock(mutex_);
  if (message.loops().empty() || message.map_epoch() != epoch_) return;
  const auto [found, is_new] = found_loops_.try_emplace({message.instance(), message.revision()});
  if (!is_new) return;
  std::map<std::uint64_t, std::int64_t> stamps;
  for (std::size_t i = 0; i < message.keyframe_ids().size(); ++i)
    stamps[message.keyframe_ids()[i]] = message.stamps()[i];
  for (const geometry::LoopMatch& match : messages::to_loops(message)) {
    const auto later = stamps.find(match.later);
    const auto earlier = stamps.find(match.earlier);
    if (later != stamps.end() && earlier != stamps.end())  // else it is of a saved map
      found->second[later->second].push_back({earlier->second, match.earlier_from_later});
  }
}

void Recorder::on_poses(const rds_msgs::msg::KeyFramePoses& message) {
  if (!messages::fault_of(message).empty()) return;
  if (message.source() == messages::kPosesOfLoopCloser) return on_loops(message);
  if (message.source() != messages::kPosesOfTracker) return;
  {
    const std::lock_guard lock(mutex_);
    if (!tracker_.accept(message.instance(), message.map_epoch() == epoch_)) return;
    if (!poses_.take(message, messages::to_keyframe_poses(message).value())) return;
    if (message.map_epoch() != recording_.map_epoch) recording_.keyframes.clear();
    for (const auto& pose : poses_.poses())
      recording_.keyframes[pose.id] = {pose.stamp_ns, pose.map_from_camera};
    recording_.keyframes_revision = message.revision();
    recording_.map_epoch = message.map_epoch();
    recording_.loops_closed = message.loops_closed();
    followed_loops_.emplace(message.loop_instance(), message.loop_revision());
  }
  changed_.notify_all();
}

void Recorder::on_detections(const vision_msgs::msg::Detection2DArray& message) {
  const auto detections = messages::to_detections(message);
  if (!detections) return;
  std::vector<DetectionRecord> records;
  for (const auto& detection : *detections)
    records.push_back({detection.label, detection.score, detection.box, detection.depth_m});
  const std::lock_guard lock(mutex_);
  recording_.detections[messages::to_nanoseconds(message.header().stamp())] = std::move(records);
}

void Recorder::on_map_info(const rds_msgs::msg::MapInfo& message) {
  {
    const std::lock_guard lock(mutex_);
    if (message.keyframes_integrated() == 0) return;
    last_mapped_id_ = std::max(last_mapped_id_.value_or(0), message.last_keyframe_id());
    const auto end = unmapped_.upper_bound(*last_mapped_id_);
    for (auto keyframe = unmapped_.begin(); keyframe != end; keyframe = unmapped_.erase(keyframe))
      recording_.map_delays_s.push_back(
          std::chrono::duration<double>(Clock::now() - keyframe->second).count());
  }
  changed_.notify_all();
}

template <class Ready>
bool Recorder::wait(const std::stop_token& stop, std::chrono::milliseconds limit, Ready ready) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, stop, limit, ready);
}

bool Recorder::wait_acknowledged(std::int64_t stamp_ns, const std::stop_token& stop,
                                 std::chrono::milliseconds limit) {
  return wait(stop, limit, [&] {
    return recording_.frames.contains(stamp_ns) && recording_.predictions.contains(stamp_ns);
  });
}

bool Recorder::wait_mapper(std::uint64_t backlog, const std::stop_token& stop,
                           std::chrono::milliseconds limit) {
  return wait(stop, limit, [&] {
    const std::uint64_t mapped = last_mapped_id_ ? *last_mapped_id_ + 1 - first_keyframe_id_ : 0;
    return keyframes_ <= mapped + backlog;
  });
}

bool Recorder::wait_poses(std::uint64_t revision, const std::stop_token& stop,
                          std::chrono::milliseconds limit) {
  return wait(stop, limit, [&] { return recording_.keyframes_revision >= revision; });
}

Recording Recorder::recording() const {
  const std::lock_guard lock(mutex_);
  Recording recording = recording_;
  for (const LoopKey& loop : followed_loops_) {
    const auto found = found_loops_.find(loop);
    if (found == found_loops_.end()) continue;
    for (const auto& [stamp, records] : found->second)
      std::ranges::copy(records, std::back_inserter(recording.loops[stamp]));
  }
  return recording;
}

std::vector<PredictionRecord> Recorder::predictions(std::int64_t stamp_ns) const {
  const std::lock_guard lock(mutex_);
  const auto found = recording_.predictions.find(stamp_ns);
  return found == recording_.predictions.end() ? std::vector<PredictionRecord>{} : found->second;
}

std::optional<FrameRecord> Recorder::frame(std::int64_t stamp_ns) const {
  const std::lock_guard lock(mutex_);
  const auto found = recording_.frames.find(stamp_ns);
  if (found == recording_.frames.end()) return std::nullopt;
  return found->second;
}

std::uint64_t Recorder::keyframes() const {
  const std::lock_guard lock(mutex_);
  return keyframes_;
}

}  // namespace rds::run
