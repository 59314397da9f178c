// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/scene_frames.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/labels/table.hpp"
#include "common/messages/detection_conversions.hpp"
#include "common/messages/json.hpp"
#include "services/mapper/core/octree/label_table.hpp"

namespace rds::viewer {
namespace {

using messages::Json;
constexpr std::size_t kMostCells = std::size_t{1} << 24;  // of a grid
constexpr std::size_t kMostBoxes = 1000;

Bytes json_frame(Kind kind, const Json& json) {
  return text_frame(kind, messages::to_text(json));
}

Json to_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Json to_json(const geometry::Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const auto& t = pose.translation();
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

Json color_of(const std::string& label) {
  const mapper::Rgb rgb = mapper::label_color(label);
  return {rgb[0], rgb[1], rgb[2]};
}

double in_ms(std::uint32_t us) {
  return us / 1e3;
}

template <class Values>
bool all_finite(const Values& values) {
  return std::ranges::all_of(values, [](auto v) { return std::isfinite(v); });
}

std::string fault_of(const rds_msgs::msg::PredictedBoxes& m) {
  const std::size_t n = m.ids().size();
  if (n > kMostBoxes) return fmt::format("{} boxes", n);
  if (m.labels().size() != n || m.scores().size() != n || m.boxes().size() != 4 * n ||
      m.minimums().size() != 3 * n || m.maximums().size() != 3 * n || m.velocities().size() != 3 * n ||
      m.ages().size() != n)
    return "arrays that do not fit each other";
  if (!all_finite(m.minimums()) || !all_finite(m.maximums()) || !all_finite(m.velocities()) ||
      !all_finite(m.boxes()))
    return "numbers that are not finite";
  return {};
}

/// Row i of a list with n values a row.
template <class Values>
Json row_of(const Values& values, std::size_t i, std::size_t n) {
  Json row = Json::array();
  for (std::size_t k = 0; k < n; ++k) row.push_back(values[n * i + k]);
  return row;
}

void put_pose(map_file::ByteWriter& frame, const geometry::Pose& pose) {
  const Eigen::Quaternionf q(pose.linear().cast<float>());
  const Eigen::Vector3f t = pose.translation().cast<float>();
  for (const float value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) frame.put(value);
}

}  // namespace

Expected<Bytes> tracking_frame(const rds_msgs::msg::TrackingState& state,
                               const std::optional<geometry::Pose>& in_submap) {
  const auto map_from_camera = messages::to_pose(state.map_from_camera());
  if (!map_from_camera) return tl::unexpected(map_from_camera.error());
  return json_frame(Kind::kTracking,
                    {{"stamp_s", static_cast<double>(messages::to_nanoseconds(state.header().stamp())) / 1e9},
                     {"state", state.state()},
                     {"pose", to_json(in_submap.value_or(*map_from_camera))},
                     {"frame", state.frame_index()},
                     {"features", state.features()},
                     {"dynamic", state.dynamic_features()},
                     {"inliers", state.inliers()},
                     {"keyframe", state.is_keyframe()},
                     {"extract_ms", in_ms(state.extract_us())},
                     {"predict_ms", in_ms(state.predict_us())},
                     {"track_ms", in_ms(state.track_us())},
                     {"total_ms", in_ms(state.total_us())},
                     {"dropped", state.frames_dropped()}});
}

Expected<Bytes> boxes_frame(const rds_msgs::msg::PredictedBoxes& boxes) {
  if (auto fault = fault_of(boxes); !fault.empty()) return tl::unexpected(std::move(fault));
  static const labels::Table kTable;
  Json list = Json::array();
  for (std::size_t i = 0; i < boxes.ids().size(); ++i)
    list.push_back({{"id", boxes.ids()[i]},
                    {"label", boxes.labels()[i]},
                    {"score", boxes.scores()[i]},
                    {"image", row_of(boxes.boxes(), i, 4)},
                    {"min", row_of(boxes.minimums(), i, 3)},
                    {"max", row_of(boxes.maximums(), i, 3)},
                    {"velocity", row_of(boxes.velocities(), i, 3)},
                    {"age_s", boxes.ages()[i]},
                    {"movable", kTable[boxes.labels()[i]].movable},
                    {"color", color_of(boxes.labels()[i])}});
  return json_frame(Kind::kBoxes, list);
}

Expected<Bytes> objects_frame(const vision_msgs::msg::Detection3DArray& objects) {
  const auto found = messages::to_detections(objects);
  if (!found) return tl::unexpected(found.error());
  Json list = Json::array();
  for (const auto& object : *found)
    list.push_back({{"id", object.id},
                    {"label", object.label},
                    {"score", object.score},
                    {"pose", to_json(object.box.map_from_box)},
                    {"size", to_json(object.box.size)},
                    {"color", color_of(object.label)}});
  return json_frame(Kind::kObjects, list);
}

Expected<Bytes> grid_frame(const nav_msgs::msg::OccupancyGrid& grid) {
  const auto& info = grid.info();
  const std::size_t cells = std::size_t{info.width()} * info.height();
  if (cells != grid.data().size() || cells > kMostCells)
    return tl::unexpected(
        fmt::format("{} × {} cells, {} values", info.width(), info.height(), grid.data().size()));
  if (!(info.resolution() > 0 && info.resolution() < 1e3F))
    return tl::unexpected(std::string("a resolution of no use"));
  const auto map_from_grid = messages::to_pose(info.origin());
  if (!map_from_grid) return tl::unexpected(map_from_grid.error());
  auto frame = begin_frame(Kind::kGrid);
  frame.put(info.width());
  frame.put(info.height());
  frame.put(info.resolution());
  put_pose(frame, *map_from_grid);
  frame.put_bytes({reinterpret_cast<const std::uint8_t*>(grid.data().data()), cells});
  return frame.take();
}

Bytes keyframes_frame(Kind kind, std::span<const geometry::KeyframePose> keyframes,
                      std::span<const Loop> loops) {
  auto frame = begin_frame(kind);
  frame.put(static_cast<std::uint32_t>(keyframes.size()));
  frame.put(static_cast<std::uint32_t>(loops.size()));
  for (const auto& keyframe : keyframes) {
    frame.put(keyframe.id);
    put_pose(frame, keyframe.map_from_camera);
    frame.put(std::uint32_t{0});
  }
  for (const Loop& loop : loops)
    for (const std::uint64_t id : loop) frame.put(id);
  return frame.take();
}

Bytes camera_frame(const geometry::CameraModel& camera) {
  return json_frame(Kind::kCamera, {{"width", camera.width},
                                    {"height", camera.height},
                                    {"fx", camera.fx},
                                    {"fy", camera.fy},
                                    {"cx", camera.cx},
                                    {"cy", camera.cy}});
}

Bytes labels_frame(std::span<const std::string> labels) {
  Json list = Json::array();
  for (const std::string& label : labels) list.push_back({{"name", label}, {"color", color_of(label)}});
  return json_frame(Kind::kLabels, list);
}

Bytes reply_frame(const std::string& verb, const rds_msgs::msg::CommandResult& result) {
  return json_frame(Kind::kReply, {{"verb", verb},
                                   {"service", result.service()},
                                   {"success", result.success()},
                                   {"message", result.message()}});
}

Expected<Bytes> picture_frame(std::span<const std::uint8_t> jpeg, std::int64_t stamp_ns, std::uint32_t width,
                              std::uint32_t height, const rds_msgs::msg::FrameFeatures* features) {
  const std::size_t n = features == nullptr ? 0 : features->verdicts().size();
  if (features != nullptr && features->positions().size() != 2 * n)
    return tl::unexpected(fmt::format("{} positions for {} features", features->positions().size(), n));
  auto frame = begin_frame(Kind::kPicture);
  frame.put(stamp_ns);
  frame.put(width);
  frame.put(height);
  frame.put(static_cast<std::uint32_t>(jpeg.size()));
  frame.put(static_cast<std::uint32_t>(n));
  for (std::size_t i = 0; i < n; ++i) {
    for (const std::size_t k : {2 * i, 2 * i + 1}) {
      const float at = features->positions()[k];
      frame.put(static_cast<std::uint16_t>(std::isfinite(at) ? std::clamp(at, 0.0F, 65535.0F) : 0.0F));
    }
    frame.put(std::uint32_t{features->verdicts()[i]});
  }
  frame.put_bytes(jpeg);
  return frame.take();
}

}  // namespace rds::viewer
