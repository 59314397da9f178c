// SPDX-License-Identifier: Apache-2.0
#include "common/messages/detection_conversions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rds::messages {
namespace {

using vision_msgs::msg::ObjectHypothesisWithPose;

const ObjectHypothesisWithPose& best(const std::vector<ObjectHypothesisWithPose>& hypotheses) {
  return *std::max_element(hypotheses.begin(), hypotheses.end(), [](const auto& a, const auto& b) {
    return a.hypothesis().score() < b.hypothesis().score();
  });
}

ObjectHypothesisWithPose hypothesis_of(const std::string& label, float score) {
  ObjectHypothesisWithPose hypothesis;
  hypothesis.hypothesis().class_id(label);
  hypothesis.hypothesis().score(static_cast<double>(score));
  hypothesis.pose().pose().orientation().w(1);
  return hypothesis;
}

Expected<geometry::Box2> to_box(const vision_msgs::msg::BoundingBox2D& message) {
  const auto& center = message.center();
  const double sine = std::abs(std::sin(center.theta()));
  const double cosine = std::abs(std::cos(center.theta()));
  const double half_width = (message.size_x() * cosine + message.size_y() * sine) / 2;
  const double half_height = (message.size_x() * sine + message.size_y() * cosine) / 2;
  const double sum = center.position().x() + center.position().y() + half_width + half_height;
  if (!std::isfinite(sum)) return tl::make_unexpected("a value is not finite");
  if (message.size_x() < 0 || message.size_y() < 0) return tl::make_unexpected("the box has a negative size");
  const double x = center.position().x();
  const double y = center.position().y();
  return geometry::Box2{x - half_width, y - half_height, x + half_width, y + half_height};
}

Expected<geometry::OrientedBox> to_box(const vision_msgs::msg::BoundingBox3D& message) {
  auto center = to_pose(message.center());
  if (!center) return tl::make_unexpected(center.error());
  const Eigen::Vector3d size(message.size().x(), message.size().y(), message.size().z());
  if (!size.allFinite()) return tl::make_unexpected("a value is not finite");
  if ((size.array() < 0).any()) return tl::make_unexpected("the box has a negative size");
  return geometry::OrientedBox{*center, size};
}

vision_msgs::msg::BoundingBox2D box_message(const geometry::Box2& box) {
  vision_msgs::msg::BoundingBox2D message;
  message.center().position().x((box.x0 + box.x1) / 2);
  message.center().position().y((box.y0 + box.y1) / 2);
  message.size_x(box.width());
  message.size_y(box.height());
  return message;
}

vision_msgs::msg::BoundingBox3D box_message(const geometry::OrientedBox& box) {
  vision_msgs::msg::BoundingBox3D message;
  message.center(to_pose_message(box.map_from_box));
  message.size().x(box.size.x());
  message.size().y(box.size.y());
  message.size().z(box.size.z());
  return message;
}

tl::unexpected<std::string> error_in(std::size_t index, const std::string& what) {
  return tl::unexpected<std::string>("detection " + std::to_string(index) + ": " + what);
}

}  // namespace

Expected<std::vector<ImageDetection>> to_detections(const vision_msgs::msg::Detection2DArray& message) {
  std::vector<ImageDetection> detections;
  for (std::size_t i = 0; i < message.detections().size(); ++i) {
    const auto& source = message.detections()[i];
    if (source.results().empty()) continue;
    const auto& top = best(source.results());
    const auto box = to_box(source.bbox());
    if (!box) return error_in(i, box.error());
    const double depth = top.pose().pose().position().z();
    const double score = top.hypothesis().score();
    if (!std::isfinite(depth) || !std::isfinite(score)) return error_in(i, "a value is not finite");
    detections.push_back(
        {top.hypothesis().class_id(), static_cast<float>(score), *box, static_cast<float>(depth)});
  }
  return detections;
}

Expected<std::vector<SpatialDetection>> to_detections(const vision_msgs::msg::Detection3DArray& message) {
  std::vector<SpatialDetection> detections;
  for (std::size_t i = 0; i < message.detections().size(); ++i) {
    const auto& source = message.detections()[i];
    if (source.results().empty()) continue;
    const auto& hypothesis = best(source.results()).hypothesis();
    const auto box = to_box(source.bbox());
    if (!box) return error_in(i, box.error());
    if (!std::isfinite(hypothesis.score())) return error_in(i, "a value is not finite");
    detections.push_back({hypothesis.class_id(), static_cast<float>(hypothesis.score()), *box, source.id()});
  }
  return detections;
}

vision_msgs::msg::Detection2DArray to_detection_message(std::span<const ImageDetection> detections,
                                                        const std_msgs::msg::Header& header) {
  vision_msgs::msg::Detection2DArray message;
  message.header(header);
  for (const ImageDetection& detection : detections) {
    vision_msgs::msg::Detection2D& target = message.detections().emplace_back();
    target.header(header);
    target.bbox(box_message(detection.box));
    target.results().push_back(hypothesis_of(detection.label, detection.score));
    target.results().back().pose().pose().position().z(static_cast<double>(detection.depth_m));
  }
  return message;
}

vision_msgs::msg::Detection3DArray to_detection_message(std::span<const SpatialDetection> detections,
                                                        const std_msgs::msg::Header& header) {
  vision_msgs::msg::Detection3DArray message;
  message.header(header);
  for (const SpatialDetection& detection : detections) {
    vision_msgs::msg::Detection3D& target = message.detections().emplace_back();
    target.header(header);
    target.bbox(box_message(detection.box));
    target.id(detection.id);
    target.results().push_back(hypothesis_of(detection.label, detection.score));
    for (const OtherLabel& other : detection.or_else)
      target.results().push_back(hypothesis_of(other.label, other.score));
    for (auto& hypothesis : target.results()) hypothesis.pose().pose(target.bbox().center());
  }
  return message;
}

}  // namespace rds::messages
