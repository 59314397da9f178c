// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/bag_recording.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "common/bus/type_ops.hpp"
#include "common/geometry/stamp.hpp"
#include "common/messages/conversions.hpp"
#include "common/topics/topics.hpp"
#include "geometry_msgs/msg/PoseStamped.h"
#include "nav_msgs/msg/Odometry.h"
#include "sensor_msgs/msg/CameraInfo.h"
#include "tools/recording/robot_topics.hpp"

namespace rds::recording {
namespace {

using geometry_msgs::msg::PoseStamped;
using nav_msgs::msg::Odometry;
using sensor_msgs::msg::CameraInfo;
using Poses = std::vector<geometry::StampedPose>;

template <class Message>
bool decode(std::span<const std::uint8_t> data, Message& message) {
  return bus::type_ops<Message>().decode(data.data(), data.size(), &message);
}

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool names_truth(const std::string& topic) {
  const std::string name = lower_case(topic);
  return name.find("ground") != std::string::npos && name.find("truth") != std::string::npos;
}

/// "/camera/color" of "/camera/color/image_raw".
std::string parent_of(const std::string& topic) {
  return topic.substr(0, topic.find_last_of('/'));
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

/// By stamp, each once. @return how many were left out.
std::size_t tidy(Stream& stream) {
  std::ranges::stable_sort(stream.entries, {}, &Stream::Entry::stamp_ns);
  const auto repeated = std::ranges::unique(stream.entries, {}, &Stream::Entry::stamp_ns);
  const auto count = static_cast<std::size_t>(repeated.size());
  stream.entries.erase(repeated.begin(), repeated.end());
  return count;
}

std::vector<std::int64_t> stamps_of(const Stream& stream) {
  std::vector<std::int64_t> stamps;
  for (const auto& entry : stream.entries) stamps.push_back(entry.stamp_ns);
  return stamps;
}

/// Whole frames per second, as cameras have them.
double rate_of(const Stream& color) {
  constexpr double kUnknown = 30;
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < color.entries.size(); ++i)
    steps.push_back(color.entries[i].stamp_ns - color.entries[i - 1].stamp_ns);
  if (steps.empty()) return kUnknown;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return std::max(1.0, std::round(1e9 / static_cast<double>(*middle)));
}

}  // namespace

/// What one pass through the bag collects.
struct BagRecording::Found {
  std::map<std::string, Stream> streams;      // by topic
  std::map<std::string, CameraInfo> cameras;  // the first message of each topic
  std::map<std::string, Poses> truths;
  RobotTopics robot;

  void see(const BagTopic& topic, const BagMessage& message, const BagPlace& place) {
    if (topic.encoding != "cdr") return;
    if (topic.type == kImageType || topic.type == kCompressedImageType) see_picture(topic, message, place);
    if (topic.type == "sensor_msgs/msg/CameraInfo" && !cameras.contains(topic.name)) {
      CameraInfo info;
      if (decode(message.data, info)) cameras.emplace(topic.name, std::move(info));
    }
    if (!names_truth(topic.name)) return robot.see(topic, message);
    if (topic.type == "geometry_msgs/msg/PoseStamped")
      see_pose<PoseStamped>(topic.name, message, [](const auto& m) { return m.pose(); });
    if (topic.type == "nav_msgs/msg/Odometry")
      see_pose<Odometry>(topic.name, message, [](const auto& m) { return m.pose().pose(); });
  }

  void see_picture(const BagTopic& topic, const BagMessage& message, const BagPlace& place) {
    const auto head = picture_head(topic, message.data);
    if (!head || head->stamp_ns < 0) return;
    Stream& stream = streams[topic.name];
    if (stream.entries.empty())
      stream = {topic.name, head->packing, head->content, head->depth_scale, head->frame};
    if (head->packing == stream.packing && head->content == stream.content)
      stream.entries.push_back({head->stamp_ns, place});
  }

  template <class Message, class PoseOf>
  void see_pose(const std::string& topic, const BagMessage& message, PoseOf pose_of) {
    Message decoded;
    if (!decode(message.data, decoded)) return;
    const auto pose = messages::to_pose(pose_of(decoded));
    if (pose) truths[topic].push_back({messages::to_nanoseconds(decoded.header().stamp()), *pose, ""});
  }

  /// The camera's description beside pictures; nullptr if there is none.
  [[nodiscard]] const std::pair<const std::string, CameraInfo>* camera_beside(
      const std::string& topic) const {
    const std::string parent = parent_of(topic);
    const auto beside = std::ranges::find_if(cameras, [&](const auto& camera) {
      const std::string folder = parent_of(camera.first);
      return folder == parent || folder == parent_of(parent);  // of …/image_raw/compressed
    });
    return beside == cameras.end() ? nullptr : &*beside;
  }

  [[nodiscard]] const Stream* best(Content content) const {
    const Stream* best = nullptr;
    for (const auto& [topic, stream] : streams)
      if (stream.content == content && (best == nullptr || rank_of(stream) < rank_of(*best))) best = &stream;
    return best;
  }
};

tl::unexpected<std::string> BagRecording::fault(const std::string& text) const {
  return tl::unexpected(fmt::format("{}: {}", path_.string(), text));
}

tl::expected<std::unique_ptr<BagRecording>, std::string> BagRecording::open(
    const std::filesystem::path& path) {
  auto bag = open_bag(path);
  if (!bag) return tl::unexpected(bag.error());
  std::unique_ptr<BagRecording> recording(new BagRecording(path, std::move(*bag)));
  Found found;
  const auto scan = recording->bag_->scan([&](const BagTopic& topic, const BagMessage& message,
                                              const BagPlace& place) { found.see(topic, message, place); });
  if (!scan) return tl::unexpected(scan.error());
  if (!scan->fault.empty()) recording->notes_ = scan->fault + "\n";
  if (const auto chosen = recording->choose(std::move(found)); !chosen) return tl::unexpected(chosen.error());
  return recording;
}

tl::expected<void, std::string> BagRecording::choose(Found found) {
  const Stream* color = found.best(Content::kColor);
  const Stream* depth = found.best(Content::kDepth);
  if (color == nullptr || depth == nullptr)
    return fault(
        fmt::format("no {} pictures, expected a topic of sensor_msgs/msg/Image or CompressedImage with {}",
                    color == nullptr ? "colour" : "depth",
                    color == nullptr ? "rgb8, bgr8, JPEG or PNG" : "16UC1 or 32FC1"));
  color_ = *color;
  depth_ = *depth;
  const auto lens = take_camera(found);
  if (!lens) return tl::unexpected(lens.error());
  repeated_ = tidy(color_) + tidy(depth_);
  if (const auto registered = register_pictures(found, *lens); !registered) return registered;
  fps_ = rate_of(color_);
  depth_scale_ = depth_.depth_scale;
  std::vector<image::FrameRef> frames;
  for (const auto& entry : color_.entries)
    frames.push_back({frames.size(), entry.stamp_ns, geometry::format_stamp(entry.stamp_ns)});
  if (pair_frames(std::move(frames), stamps_of(depth_), image::kPairingToleranceNs) == 0)
    return fault(fmt::format("no picture of {} has one of {} within {} ms", color_.topic, depth_.topic,
                             image::kPairingToleranceNs / 1'000'000));
  if (!found.truths.empty()) {
    ground_truth_ = std::move(found.truths.begin()->second);
    std::ranges::stable_sort(*ground_truth_, {}, &geometry::StampedPose::stamp_ns);
  }
  return {};
}

/// The camera's description beside the colour pictures, or the only one.
tl::expected<geometry::Lens, std::string> BagRecording::take_camera(const Found& found) {
  const auto* chosen = found.camera_beside(color_.topic);
  if (chosen == nullptr && found.cameras.size() == 1) chosen = &*found.cameras.begin();
  if (chosen == nullptr)
    return fault(
        fmt::format("no camera_info for {}, expected a topic {}/camera_info of sensor_msgs/msg/CameraInfo",
                    color_.topic, parent_of(color_.topic)));
  const auto lens = messages::to_lens(chosen->second);
  if (!lens) return fault(fmt::format("{}: {}", chosen->first, lens.error()));
  camera_ = lens->camera();
  notes_ += fmt::format("{}: colour {}, depth {}, camera {}\n", path_.string(), color_.topic, depth_.topic,
                        chosen->first);
  return *lens;
}

/// Depth comes to colour's frame, both without distortion; and the robot's sensors have their place there.
tl::expected<void, std::string> BagRecording::register_pictures(const Found& found,
                                                                const geometry::Lens& color_lens) {
  const cv::Size color_size(camera_.width, camera_.height);
  depth_size_ = first_depth_size().value_or(color_size);
  RecordedCamera depth{depth_size_, depth_.frame};
  if (const auto* info = found.camera_beside(depth_.topic))
    if (const auto lens = messages::to_lens(info->second)) depth.lens = *lens;
  auto made = picture_makers({color_size, color_.frame, color_lens}, depth, found.robot);
  if (!made) return fault(fmt::format("{}: {}", depth_.topic, made.error()));
  make_ = std::move(*made);
  if (!make_.note.empty()) notes_ += fmt::format("{}: {}: {}\n", path_.string(), depth_.topic, make_.note);
  sensors_ = found.robot.sensors({color_.frame, path_.string()}, notes_);
  return {};
}

/// Of the first picture that can be decoded, of those at the beginning.
std::optional<cv::Size> BagRecording::first_depth_size() const {
  constexpr std::size_t kTries = 10;
  for (std::size_t i = 0; i < std::min(kTries, depth_.entries.size()); ++i) {
    const auto data = bag_->data_at(depth_.entries[i].place);
    const auto picture = data ? decode_depth(depth_.packing, *data) : tl::unexpected(data.error());
    if (picture) return picture->values.size();
  }
  return std::nullopt;
}

std::string BagRecording::place_of(const Stream& stream, std::size_t index) const {
  return fmt::format("{}: {} at {}", path_.string(), stream.topic,
                     geometry::format_stamp(stream.entries[index].stamp_ns));
}

tl::expected<image::ColorImage, std::string> BagRecording::load_color(std::size_t index) const {
  const auto data = bag_->data_at(color_.entries[index].place);
  if (!data) return tl::unexpected(data.error());
  auto picture = decode_color(color_.packing, *data);
  if (!picture) return tl::unexpected(fmt::format("{}: {}", place_of(color_, index), picture.error()));
  if (picture->pixels.size() != cv::Size(camera_.width, camera_.height))
    return tl::unexpected(fmt::format("{}: {}×{} px, expected {}×{} as camera_info says",
                                      place_of(color_, index), picture->pixels.cols, picture->pixels.rows,
                                      camera_.width, camera_.height));
  if (make_.color) return make_.color(*picture);
  return picture;
}

tl::expected<image::DepthImage, std::string> BagRecording::load_depth(std::size_t index) const {
  const auto data = bag_->data_at(depth_.entries[index].place);
  if (!data) return tl::unexpected(data.error());
  auto picture = decode_depth(depth_.packing, *data);
  if (!picture) return tl::unexpected(fmt::format("{}: {}", place_of(depth_, index), picture.error()));
  if (picture->values.size() != depth_size_)
    return tl::unexpected(fmt::format("{}: {}×{} px, expected {}×{} as those before", place_of(depth_, index),
                                      picture->values.cols, picture->values.rows, depth_size_.width,
                                      depth_size_.height));
  if (make_.depth) return make_.depth(*picture);
  return picture;
}

}  // namespace rds::recording
