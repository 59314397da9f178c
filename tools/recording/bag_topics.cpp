// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/bag_topics.hpp"

#include <algorithm>
#include <cctype>
#include <tuple>

#include "common/messages/conversions.hpp"
#include "common/topics/topics.hpp"
#include "geometry_msgs/msg/PoseStamped.h"
#include "nav_msgs/msg/Odometry.h"
#include "tools/recording/decode.hpp"

namespace rds::recording {
namespace {

using geometry_msgs::msg::PoseStamped;
using nav_msgs::msg::Odometry;
using sensor_msgs::msg::CameraInfo;

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool names_truth(const std::string& topic) {
  const std::string name = lower_case(topic);
  return name.find("ground") != std::string::npos && name.find("truth") != std::string::npos;
}

/// How well a topic fits what it is wanted for; a smaller one is better.
auto rank_of(const Stream& stream) {
  const bool is_color = stream.content == Content::kColor;
  const std::string ours = std::string("/") + (is_color ? topics::kColor.name : topics::kDepth.name);
  const auto has = [&](const char* word) { return stream.topic.find(word) != std::string::npos; };
  const bool marked = is_color ? has("color") || has("rgb") : has("aligned") || has("registered");
  return std::tuple(stream.topic != ours, !marked, -static_cast<std::int64_t>(stream.entries.size()),
                    stream.packing != Packing::kRaw, stream.topic);
}

}  // namespace

std::string parent_of(const std::string& topic) {
  return topic.substr(0, topic.find_last_of('/'));
}

void BagTopics::see(const BagTopic& topic, const BagMessage& message, const BagPlace& place) {
  if (topic.encoding != "cdr") return;
  if (topic.type == kImageType || topic.type == kCompressedImageType) see_picture(topic, message, place);
  if (topic.type == "sensor_msgs/msg/CameraInfo" && !cameras_.contains(topic.name)) {
    if (auto info = decode<CameraInfo>(message.data)) cameras_.emplace(topic.name, std::move(*info));
  }
  if (!names_truth(topic.name)) return robot_.see(topic, message);
  if (topic.type == "geometry_msgs/msg/PoseStamped")
    see_pose<PoseStamped>(topic.name, message, [](const auto& m) { return m.pose(); });
  if (topic.type == "nav_msgs/msg/Odometry")
    see_pose<Odometry>(topic.name, message, [](const auto& m) { return m.pose().pose(); });
}

void BagTopics::see_picture(const BagTopic& topic, const BagMessage& message, const BagPlace& place) {
  const auto head = picture_head(topic, message.data);
  if (!head || head->stamp_ns < 0) return;
  Stream& stream = streams_[topic.name];
  if (stream.entries.empty())
    stream = {topic.name, head->packing, head->content, head->depth_scale, head->frame};
  if (head->packing == stream.packing && head->content == stream.content)
    stream.entries.push_back({head->stamp_ns, place});
}

template <class Message, class PoseOf>
void BagTopics::see_pose(const std::string& topic, const BagMessage& message, PoseOf pose_of) {
  const auto decoded = decode<Message>(message.data);
  if (!decoded) return;
  const auto pose = messages::to_pose(pose_of(*decoded));
  if (pose) truths_[topic].push_back({messages::to_nanoseconds(decoded->header().stamp()), *pose, ""});
}

const Stream* BagTopics::best(Content content) const {
  const Stream* best = nullptr;
  for (const auto& [topic, stream] : streams_)
    if (stream.content == content && (best == nullptr || rank_of(stream) < rank_of(*best))) best = &stream;
  return best;
}

const BagTopics::Camera* BagTopics::camera_beside(const std::string& topic) const {
  const std::string parent = parent_of(topic);
  const auto beside = std::ranges::find_if(cameras_, [&](const auto& camera) {
    const std::string folder = parent_of(camera.first);
    return folder == parent || folder == parent_of(parent);  // of …/image_raw/compressed
  });
  return beside == cameras_.end() ? nullptr : &*beside;
}

const BagTopics::Camera* BagTopics::camera_of(const std::string& topic) const {
  const Camera* beside = camera_beside(topic);
  return beside == nullptr && cameras_.size() == 1 ? &*cameras_.begin() : beside;
}

const std::vector<geometry::StampedPose>* BagTopics::truth() const {
  return truths_.empty() ? nullptr : &truths_.begin()->second;
}

}  // namespace rds::recording
