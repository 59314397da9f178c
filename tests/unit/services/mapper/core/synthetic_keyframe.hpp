// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/pipeline.hpp"
#include "services/mapper/core/segmentation/classify.hpp"
#include "services/mapper/core/semantic_mapper.hpp"

namespace rds::mapper::test {

/// 320×240 camera at the origin of the map, looking along z.
inline geometry::CameraModel small_camera() {
  return {320, 240, 290, 290, 159.5, 119.5, {}};
}

/// Fluent maker of keyframes: a grey wall filling the picture, with rectangles before it.
class SyntheticKeyframe {
 public:
  explicit SyntheticKeyframe(std::uint64_t id, double wall_m = 3.0) {
    input_.id = id;
    input_.stamp_ns = static_cast<std::int64_t>(id) * 100'000'000;
    input_.camera = small_camera();
    input_.color.pixels = cv::Mat(240, 320, CV_8UC3, cv::Scalar(90, 100, 110));
    input_.depth.values = cv::Mat(240, 320, CV_32FC1, cv::Scalar(wall_m));
    input_.depth.metres_per_unit = 1.0F;
  }

  /// A rectangle of the picture at another depth [m] (0 or NaN: no measurement) and colour.
  SyntheticKeyframe& rectangle(const cv::Rect& px, double depth_m, const cv::Scalar& bgr = {200, 50, 50}) {
    input_.depth.values(px).setTo(cv::Scalar(depth_m));
    input_.color.pixels(px).setTo(bgr);
    return *this;
  }
  SyntheticKeyframe& box(const std::string& label, const cv::Rect& px, bool movable, float score = 0.9F) {
    if (!input_.boxes) input_.boxes.emplace();
    const geometry::Box2 box{double{1} * px.x, double{1} * px.y, double{1} * px.br().x,
                             double{1} * px.br().y};
    input_.boxes->push_back({label, score, box, std::nullopt, 0.0F, movable});
    return *this;
  }
  SyntheticKeyframe& looked_for_objects() {
    if (!input_.boxes) input_.boxes.emplace();
    return *this;
  }
  SyntheticKeyframe& pose(const geometry::Pose& map_from_camera) {
    input_.map_from_camera = map_from_camera;
    return *this;
  }
  /// Cells of 4 px in which the tracker found something that moves.
  SyntheticKeyframe& movable_cells(const cv::Rect& px) {
    if (input_.movable_cells.empty()) input_.movable_cells = cv::Mat1b(60, 80, std::uint8_t{0});
    input_.movable_cells(cv::Rect(px.x / 4, px.y / 4, px.width / 4, px.height / 4)).setTo(255);
    return *this;
  }
  operator KeyframeInput() const { return input_; }  // NOLINT: a maker stands for what it makes
  [[nodiscard]] KeyframeInput make() const { return input_; }

 private:
  KeyframeInput input_;
};

/// A keyframe with classes by depth alone.
inline KeyframeRecord measured(const KeyframeInput& input, const SamplingConfig& config = {}) {
  auto record = make_record(input, config, std::make_shared<SampledRays>(input.camera, config));
  classify_by_depth(record, config);
  return record;
}

/// What the mapper makes of a keyframe and its boxes.
inline KeyframeRecord record_of(const KeyframeInput& input, LabelTable& labels,
                                const MapperConfig& config = {}) {
  auto record = make_record(input, config.sampling,
                            std::make_shared<SampledRays>(input.camera, config.sampling));
  interpret(record, input.boxes, config, labels);
  return record;
}

/// Map point [m] that a pixel at a depth shows, for a camera at the origin.
inline Eigen::Vector3d point_at(double x_px, double y_px, double depth_m) {
  return small_camera().ray({x_px, y_px}) * depth_m;
}

/// Log-odds of the voxel at a point; NaN where the map knows nothing.
inline float log_odds_at(const octomap::ColorOcTree& tree, const Eigen::Vector3d& p) {
  const auto* node = tree.search(p.x(), p.y(), p.z());
  return node != nullptr ? node->getLogOdds() : std::numeric_limits<float>::quiet_NaN();
}

inline bool is_occupied(const octomap::ColorOcTree& tree, const Eigen::Vector3d& p) {
  return log_odds_at(tree, p) > 0;
}

/// Number of occupied voxels with lower ≤ z < upper [m].
inline int occupied_between(const octomap::ColorOcTree& tree, double lower, double upper) {
  int count = 0;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
    count += leaf.getZ() >= lower && leaf.getZ() < upper && tree.isNodeOccupied(*leaf) ? 1 : 0;
  return count;
}

/// As the mapper's part of a saved map.
inline map_file::Bytes saved_bytes(const SemanticMapper& mapper) {
  return to_bytes(mapper.map(), mapper.up_in_map());
}

/// Goes on from such bytes or from a tree, if they fit.
template <class Saved>
tl::expected<void, std::string> start_from(SemanticMapper& mapper, Saved&& saved,
                                           const MapperConfig& config = {}) {
  auto map = saved_map_from(std::forward<Saved>(saved), config);
  if (!map) return tl::unexpected(map.error());
  mapper.start_from(std::move(*map));
  return {};
}

}  // namespace rds::mapper::test
