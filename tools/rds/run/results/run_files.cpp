// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/results/run_files.hpp"

#include <limits>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/geometry/stamp.hpp"
#include "common/geometry/trajectory.hpp"
#include "common/messages/json.hpp"
#include "tools/rds/run/output/result_file.hpp"

namespace rds::run {
namespace {

using geometry::format_stamp;
using geometry::StampedPose;
using nlohmann::ordered_json;

void write(const std::filesystem::path& file, const std::vector<StampedPose>& poses) {
  const auto written = geometry::write_trajectory(file, poses);
  if (!written) throw std::runtime_error(written.error());
}

std::vector<StampedPose> keyframes(const Recording& recording) {
  std::vector<StampedPose> poses;
  for (const auto& [id, keyframe] : recording.keyframes)
    poses.push_back({keyframe.stamp_ns, keyframe.map_from_camera, {}});
  return poses;
}

void write_frames(const Recording& recording, const std::filesystem::path& file) {
  std::ostringstream out;
  out << "stamp,state,features,dynamic_features,inliers,extract_ms,predict_ms,track_ms,total_ms,boxes\n";
  for (const auto& [stamp, f] : recording.frames) {
    const auto boxes = recording.predictions.find(stamp);
    out << fmt::format("{},{},{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{}\n", format_stamp(stamp), f.state,
                       f.features, f.dynamic_features, f.inliers, f.extract_ms, f.predict_ms, f.track_ms,
                       f.total_ms, boxes == recording.predictions.end() ? 0 : boxes->second.size());
  }
  write_result(file, out.str());
}

/// A number with at most `decimals` decimals, so that files stay readable and equal runs give equal bytes.
double rounded(double value, int decimals) {
  return std::stod(fmt::format("{:.{}f}", value, decimals));
}

ordered_json to_json(const geometry::Box2& box) {
  return {rounded(box.x0, 2), rounded(box.y0, 2), rounded(box.x1, 2), rounded(box.y1, 2)};
}

ordered_json to_json(const Eigen::Vector3d& v) {
  return {rounded(v.x(), 4), rounded(v.y(), 4), rounded(v.z(), 4)};
}

/// One line per stamp: {"stamp": 1.5, NAME: [...]}; the stamp keeps its digits.
template <class Records, class ToJson>
void write_lines(const std::map<std::int64_t, Records>& by_stamp, const std::string& name,
                 const std::filesystem::path& file, ToJson to_json_of) {
  std::ostringstream out;
  for (const auto& [stamp, records] : by_stamp) {
    auto list = ordered_json::array();
    for (const auto& record : records) list.push_back(to_json_of(record));
    out << fmt::format("{{\"stamp\": {}, \"{}\": {}}}\n", format_stamp(stamp), name, messages::to_text(list));
  }
  write_result(file, out.str());
}

ordered_json detection_json(const DetectionRecord& d) {
  return {{"label", d.label},
          {"score", rounded(d.score, 4)},
          {"box", to_json(d.box)},
          {"depth_m", rounded(d.depth_m, 3)}};
}

ordered_json prediction_json(const PredictionRecord& p) {
  return {{"id", p.id},
          {"label", p.label},
          {"box", to_json(p.box)},
          {"min", to_json(p.volume.min)},
          {"max", to_json(p.volume.max)},
          {"velocity", to_json(p.velocity)},
          {"age_s", rounded(p.age_s, 3)}};
}

/// The stamp keeps its digits to the microsecond, as a number can.
ordered_json loop_json(const LoopRecord& loop) {
  const Eigen::Vector3d t = loop.earlier_from_later.translation();
  const Eigen::Quaterniond q(loop.earlier_from_later.linear());
  auto pose = ordered_json::array();
  for (const double number : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()})
    pose.push_back(rounded(number, 6));
  return {{"earlier", rounded(static_cast<double>(loop.earlier_ns) * 1e-9, 6)}, {"earlier_from_later", pose}};
}

}  // namespace

std::vector<StampedPose> live_trajectory(const Recording& recording) {
  std::vector<StampedPose> poses;
  for (const auto& [stamp, frame] : recording.frames)
    if (frame.has_pose) poses.push_back({stamp, frame.map_from_camera, {}});
  return poses;
}

std::vector<StampedPose> optimized_trajectory(const Recording& recording) {
  std::vector<StampedPose> poses;
  // Without its keyframe a pose is final: of a saved map, whose keyframes do not move; of an earlier epoch;
  // of a tracker that was killed before its last checkpoint had them. In a submap that was joined to the map
  // a frame got its pose afterwards.
  for (const auto& [stamp, frame] : recording.frames) {
    const auto reference = recording.keyframes.find(frame.reference_keyframe_id);
    const bool has_moved = frame.map_epoch == recording.map_epoch && reference != recording.keyframes.end();
    const bool is_placed = frame.has_pose || (frame.is_in_submap && has_moved);
    if (!is_placed) continue;
    poses.push_back(
        {stamp,
         has_moved ? reference->second.map_from_camera * frame.reference_from_camera : frame.map_from_camera,
         {}});
  }
  return poses;
}

std::vector<StampedPose> in_first_camera(std::vector<StampedPose> poses, const Recording& recording) {
  std::map<std::uint64_t, geometry::Pose> first_camera_from_map;  // by epoch
  for (const auto& [stamp, frame] : recording.frames)
    if (frame.has_pose) first_camera_from_map.emplace(frame.map_epoch, frame.map_from_camera.inverse());
  for (StampedPose& pose : poses) {
    const std::uint64_t epoch = recording.frames.at(pose.stamp_ns).map_epoch;
    pose.map_from_camera = first_camera_from_map.at(epoch) * pose.map_from_camera;
  }
  return poses;
}

void write_run_files(const Recording& recording, const std::filesystem::path& folder,
                     bool trajectories_in_map) {
  const auto framed = [&](std::vector<StampedPose> poses) {
    return trajectories_in_map ? poses : in_first_camera(std::move(poses), recording);
  };
  write(folder / "trajectory.txt", framed(live_trajectory(recording)));
  write(folder / "trajectory_optimized.txt", framed(optimized_trajectory(recording)));
  write(folder / "keyframes.txt", keyframes(recording));
  write_frames(recording, folder / "frames.csv");
  write_lines(recording.detections, "detections", folder / "detections.jsonl", detection_json);
  write_lines(recording.loops, "loops", folder / "loops.jsonl", loop_json);
  write_lines(recording.predictions, "boxes", folder / "predictions.jsonl", prediction_json);
}

}  // namespace rds::run
