// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/bag_recording.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/geometry/stamp.hpp"
#include "common/messages/conversions.hpp"
#include "tools/recording/bag_topics.hpp"

namespace rds::recording {
namespace {

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

tl::unexpected<std::string> BagRecording::fault(const std::string& text) const {
  return tl::unexpected(fmt::format("{}: {}", path_.string(), text));
}

tl::expected<std::unique_ptr<BagRecording>, std::string> BagRecording::open(
    const std::filesystem::path& path) {
  auto bag = open_bag(path);
  if (!bag) return tl::unexpected(bag.error());
  std::unique_ptr<BagRecording> recording(new BagRecording(path, std::move(*bag)));
  BagTopics found;
  const auto scan = recording->bag_->scan([&](const BagTopic& topic, const BagMessage& message,
                                              const BagPlace& place) { found.see(topic, message, place); });
  if (!scan) return tl::unexpected(scan.error());
  if (!scan->fault.empty()) recording->notes_ = scan->fault + "\n";
  if (const auto chosen = recording->choose(found); !chosen) return tl::unexpected(chosen.error());
  return recording;
}

tl::expected<void, std::string> BagRecording::choose(const BagTopics& found) {
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
  if (const auto* truth = found.truth()) {
    ground_truth_ = *truth;
    std::ranges::stable_sort(*ground_truth_, {}, &geometry::StampedPose::stamp_ns);
  }
  return {};
}

/// The camera's description beside the colour pictures, or the only one.
tl::expected<geometry::Lens, std::string> BagRecording::take_camera(const BagTopics& found) {
  const auto* chosen = found.camera_of(color_.topic);
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
tl::expected<void, std::string> BagRecording::register_pictures(const BagTopics& found,
                                                                const geometry::Lens& color_lens) {
  const cv::Size color_size(camera_.width, camera_.height);
  depth_size_ = first_depth_size().value_or(color_size);
  RecordedCamera depth{depth_size_, depth_.frame};
  if (const auto* info = found.camera_beside(depth_.topic))
    if (const auto lens = messages::to_lens(info->second)) depth.lens = *lens;
  auto made = picture_makers({color_size, color_.frame, color_lens}, depth, found.robot());
  if (!made) return fault(fmt::format("{}: {}", depth_.topic, made.error()));
  make_ = std::move(*made);
  if (!make_.note.empty()) notes_ += fmt::format("{}: {}: {}\n", path_.string(), depth_.topic, make_.note);
  sensors_ = found.robot().sensors({color_.frame, path_.string()}, notes_);
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
