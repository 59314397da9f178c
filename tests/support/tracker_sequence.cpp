// SPDX-License-Identifier: Apache-2.0
#include "tests/support/tracker_sequence.hpp"

#include <array>
#include <chrono>
#include <ctime>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "services/transformer/core/box_transform.hpp"

namespace rds::test {
namespace {

using geometry::StampedPose;
using segmentation::ObjectRegion;

/// Boxes of the people in people.json, by frame.
std::vector<std::vector<segmentation::ObjectRegion>> read_truth_boxes(const std::filesystem::path& dataset) {
  constexpr double kMargin = 8;       // px
  constexpr float kHalfDepth = 0.6F;  // m
  std::ifstream file(dataset / "people.json");
  if (!file) throw std::runtime_error((dataset / "people.json").string() + ": cannot be read");
  std::vector<std::vector<segmentation::ObjectRegion>> all;
  const auto people = nlohmann::json::parse(file);
  for (const auto& frame : people.at("frames")) {
    auto& regions = all.emplace_back();
    for (const auto& person : frame.at("people")) {
      const auto box = person.at("box").get<std::array<double, 4>>();
      const auto distance = person.at("distance").get<float>();
      regions.push_back({{box[0] - kMargin, box[1] - kMargin, box[2] + kMargin, box[3] + kMargin},
                         distance - kHalfDepth,
                         distance + kHalfDepth});
    }
  }
  return all;
}

std::int64_t now_us() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

}  // namespace

TrackerSequence::TrackerSequence(const TrackerSequenceOptions& options, const image::TumDataset& dataset,
                                 const tracker::TrackerConfig& config)
    : options_(options),
      dataset_(dataset),
      config_(config),
      tracker_(config, {.now_us = now_us, .gyroscope = options.gyroscope}),
      objects_({}) {
  if (!options.detections.empty()) detections_ = read_detections(options.detections);
  if (options.truth_boxes || options.late_boxes) boxes_ = read_truth_boxes(dataset.folder());
}

tracker::FrameResult TrackerSequence::step(std::size_t i) {
  const auto frame = dataset_.load(dataset_.frames()[i]);
  if (!frame) throw std::runtime_error(frame.error());
  apply_due(i);
  const auto start = processor_ms();
  const auto expected = regions(i, *frame);
  tracker::FrameResult result = tracker_.track(*frame, expected);
  times_.total.push_back(processor_ms() - start);
  times_.extract_wall.push_back(static_cast<double>(result.times.extract_us) / 1000);
  record(i, result);
  if (!options_.pictures.empty() && i % 10 == 0) draw_removal(*frame, i, expected, result);
  if (!result.keyframe) return result;
  ++keyframes_;
  if (options_.late_boxes || !detections_.empty())
    due_boxes_.push_back(
        {i + options_.box_latency, i, result.keyframe->id, result.keyframe->map_from_camera, frame->camera});
  run_mapping(i);
  return result;
}

std::vector<std::vector<TrackerSequence::Detected>> TrackerSequence::read_detections(
    const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file + ": cannot be read");
  std::vector<std::vector<Detected>> all;
  for (std::string line; std::getline(in, line);) {
    auto& detected = all.emplace_back();
    const auto of_frame = nlohmann::json::parse(line);
    for (const auto& d : of_frame.at("detections")) {
      const auto box = d.at("box").get<std::array<double, 4>>();
      detected.push_back({{box[0], box[1], box[2], box[3]},
                          d.at("label").get<std::string>(),
                          d.at("score").get<float>(),
                          d.at("depth_m").get<double>()});
    }
  }
  return all;
}

std::vector<segmentation::ObjectRegion> TrackerSequence::regions(std::size_t i,
                                                                  const image::RgbdFrame& frame) const {
  if (options_.truth_boxes) return boxes_.at(i);
  return objects_.regions(frame.stamp_ns, tracker_.expected_camera_from_map(frame.stamp_ns), frame.camera);
}

void TrackerSequence::apply_boxes(const DueBoxes& due) {
  if (options_.late_boxes) return tracker_.retract_movable(due.keyframe, boxes_.at(due.frame));
  std::vector<tracker::prediction::ObjectObservation> observations;
  for (const Detected& d : detections_.at(due.frame))
    if (const auto box = transformer::box_in_map(d.box, d.depth_m, d.label, due.map_from_camera, due.camera))
      observations.push_back({*box, d.label, d.score});
  objects_.observe(dataset_.frames()[due.frame].stamp_ns, observations,
                   tracker::prediction::KeyframeView{due.map_from_camera, due.camera});
  tracker_.retract_movable(due.keyframe,
                           objects_.regions_of(observations, due.map_from_camera.inverse(), due.camera));
}

void TrackerSequence::draw_removal(const image::RgbdFrame& frame, std::size_t i,
                                   const std::vector<segmentation::ObjectRegion>& regions,
                                   const tracker::FrameResult& result) const {
  cv::Mat picture = frame.color.bgr().clone();
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      if (result.movable.covers({x, y})) picture.at<cv::Vec3b>(y, x)[2] = 255;
  for (const segmentation::ObjectRegion& r : regions)
    cv::rectangle(picture, cv::Point2d(r.box_px.x0, r.box_px.y0), cv::Point2d(r.box_px.x1, r.box_px.y1),
                  {255, 0, 0}, 2);
  for (const auto& v : result.verdicts)
    if (v.use == tracker::KeypointVerdict::Use::kUsed)
      cv::circle(picture, cv::Point2f(v.image_px.x(), v.image_px.y()), 3, {0, 255, 0}, 1);
  cv::imwrite((std::filesystem::path(options_.pictures) / fmt::format("{:04d}.jpg", i)).string(), picture);
}

void TrackerSequence::compare_removal(std::size_t i, const tracker::FrameResult& result) {
  const auto name = dataset_.color_list().entries[i].picture.stem().string() + ".png";
  const cv::Mat1b people = cv::imread((dataset_.folder() / "masks" / name).string(), cv::IMREAD_GRAYSCALE);
  if (people.empty()) throw std::runtime_error("masks/" + name + ": cannot be read");
  const int on_people = cv::countNonZero(people);
  if (on_people == 0 || !tracker::has_pose(result.state)) return;
  int removed_people = 0;
  int removed = 0;
  for (int y = 0; y < people.rows; ++y)
    for (int x = 0; x < people.cols; ++x)
      if (result.movable.covers({x, y})) {
        ++removed;
        removed_people += people(y, x) != 0 ? 1 : 0;
      }
  int used = 0;
  int used_people = 0;
  for (const auto& v : result.verdicts) {
    if (v.use != tracker::KeypointVerdict::Use::kUsed) continue;
    ++used;
    used_people +=
        people(static_cast<int>(v.image_px.y() + 0.5F), static_cast<int>(v.image_px.x() + 0.5F)) != 0;
  }
  ++removal_.frames;
  removal_.people += static_cast<double>(removed_people) / on_people;
  removal_.rest += static_cast<double>(removed - removed_people) /
                   std::max(1.0, static_cast<double>(people.total()) - on_people);
  removal_.features += static_cast<double>(used_people) / std::max(1, used);
  if (options_.verbose)
    fmt::print(
        "{} removed of people {:.3f} of rest {:.3f} features on people {} of {}\n", i,
        static_cast<double>(removed_people) / on_people,
        static_cast<double>(removed - removed_people) / (static_cast<double>(people.total()) - on_people),
        used_people, used);
}

void TrackerSequence::record(std::size_t i, const tracker::FrameResult& result) {
  ++states_[static_cast<int>(result.state)];
  if (options_.verbose)
    fmt::print("{} state {} features {} dynamic {} inliers {} kf {} ref {} points {} ms {:.1f} kept {}\n", i,
               static_cast<int>(result.state), result.features, result.dynamic_features, result.inliers,
               result.keyframe.has_value(), result.reference_keyframe_id, tracker_.map().points().size(),
               times_.total.back(), tracker_.map().keyframes().size());
  if (options_.masks) compare_removal(i, result);
  if (!tracker::has_pose(result.state)) return;
  const auto& frame = dataset_.frames()[i];
  live_.push_back({frame.stamp_ns, result.map_from_camera, frame.stamp_text});
  tracked_.push_back({i, result.reference_keyframe_id, result.reference_from_camera});
}

std::vector<StampedPose> TrackerSequence::optimized() const {
  std::vector<StampedPose> poses;
  const auto keyframes = tracker_.keyframe_poses();
  for (const auto& [i, reference, reference_from_camera] : tracked_) {
    const auto keyframe = std::ranges::lower_bound(keyframes, reference, {}, &tracker::KeyframePose::id);
    if (keyframe == keyframes.end() || keyframe->id != reference) continue;  // in a submap
    const auto& frame = dataset_.frames()[i];
    poses.push_back({frame.stamp_ns, keyframe->map_from_camera * reference_from_camera, frame.stamp_text});
  }
  return poses;
}

void TrackerSequence::apply_due(std::size_t i) {
  for (; !due_boxes_.empty() && due_boxes_.front().at <= i; due_boxes_.pop_front())
    apply_boxes(due_boxes_.front());
  if (!result_ || result_due_ > i) return;
  const auto start = processor_ms();
  tracker_.apply(*result_);
  times_.apply.push_back(processor_ms() - start);
  result_.reset();
}

void TrackerSequence::join_submaps() {
  if (tracker_.map().records().submaps().is_whole()) return;
  const auto start = processor_ms();
  (void)tracker_.join_submaps();
  times_.joining.push_back(processor_ms() - start);
}

void TrackerSequence::run_mapping(std::size_t i) {
  join_submaps();
  if (options_.no_mapping || result_) return;
  const auto start = processor_ms();
  const auto job = tracker_.take_mapping_job();
  times_.snapshot.push_back(processor_ms() - start);
  if (!job) return;
  const auto begin = processor_ms();
  result_ = tracker::run_local_mapping(*job);
  times_.mapping.push_back(processor_ms() - begin);
  result_due_ = i + options_.mapping_latency;
}

}  // namespace rds::test
