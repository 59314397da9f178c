// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/benchmarks/numbered_recording.hpp"

#include <algorithm>
#include <istream>

#include <opencv2/imgproc.hpp>

#include "common/geometry/stamp.hpp"
#include "common/geometry/text_line.hpp"
#include "common/image/picture_file.hpp"

namespace rds::recording {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::int64_t kFramesPerSecond = 30;
constexpr std::int64_t kStartS = 1;  // stamp of frame 0; a stamp of 0 is nobody's
constexpr std::uint64_t kMostNumber = 1'000'000'000;

std::int64_t stamp_of(std::uint64_t number) {
  return kStartS * kNanosecondsPerSecond +
         static_cast<std::int64_t>(number) * kNanosecondsPerSecond / kFramesPerSecond;
}

/// Pixels of `to` from pixels of `from`, two cameras in one place.
cv::Matx23d pixels_between(const geometry::CameraModel& from, const geometry::CameraModel& to) {
  const double x = to.fx / from.fx;
  const double y = to.fy / from.fy;
  return {x, 0, to.cx - x * from.cx, 0, y, to.cy - y * from.cy};
}

}  // namespace

NumberedRecording::NumberedRecording(NumberedForm form, std::vector<Entry> entries, const Truth& truth)
    : form_(std::move(form)), entries_(std::move(entries)) {
  camera_ = form_.camera;
  depth_scale_ = form_.depth_scale;
  fps_ = static_cast<double>(kFramesPerSecond);
  std::ranges::sort(entries_, {}, &Entry::number);
  const auto repeated = std::ranges::unique(entries_, {}, &Entry::number);
  entries_.erase(repeated.begin(), repeated.end());
  std::vector<image::FrameRef> frames;
  std::vector<std::int64_t> stamps;
  for (const Entry& entry : entries_) {
    const std::int64_t stamp_ns = stamp_of(entry.number);
    frames.push_back({frames.size(), stamp_ns, geometry::format_stamp(stamp_ns)});
    stamps.push_back(stamp_ns);
  }
  pair_frames(std::move(frames), std::move(stamps), 0);
  if (truth.empty()) return;
  ground_truth_.emplace();
  for (const auto& [number, pose] : truth) ground_truth_->push_back({stamp_of(number), pose, ""});
  std::ranges::stable_sort(*ground_truth_, {}, &geometry::StampedPose::stamp_ns);
}

tl::expected<image::ColorImage, std::string> NumberedRecording::load_color(std::size_t index) const {
  const geometry::CameraModel& seen_by = form_.color_camera.value_or(camera_);
  auto pixels = image::read_color_picture(entries_[index].color, {seen_by.width, seen_by.height});
  if (!pixels) return tl::unexpected(pixels.error());
  if (form_.color_camera)
    cv::warpAffine(cv::Mat(*pixels), *pixels, pixels_between(seen_by, camera_),
                   {camera_.width, camera_.height}, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return image::ColorImage{std::move(*pixels), image::ChannelOrder::kBgr, nullptr};
}

tl::expected<image::DepthImage, std::string> NumberedRecording::load_depth(std::size_t index) const {
  auto values = image::read_depth_picture(entries_[index].depth, {camera_.width, camera_.height});
  if (!values) return tl::unexpected(values.error());
  if (form_.no_depth != 0) values->setTo(0, *values == form_.no_depth);
  return image::DepthImage{std::move(*values), static_cast<float>(1 / depth_scale_), nullptr};
}

std::optional<std::uint64_t> number_in(std::string_view text) {
  const auto number = geometry::parse_number(text);
  if (!number || *number < 0 || *number > static_cast<double>(kMostNumber)) return std::nullopt;
  return static_cast<std::uint64_t>(*number);
}

std::optional<std::uint64_t> number_in(const std::string& name, std::string_view start,
                                       std::string_view ending) {
  if (name.size() <= start.size() + ending.size() || !name.starts_with(start) || !name.ends_with(ending))
    return std::nullopt;
  return number_in(std::string_view(name).substr(start.size(), name.size() - start.size() - ending.size()));
}

std::vector<std::pair<std::uint64_t, fs::path>> numbered_files(const fs::path& folder, std::string_view start,
                                                               std::string_view ending) {
  std::vector<std::pair<std::uint64_t, fs::path>> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (const auto number = number_in(entry.path().filename().string(), start, ending))
      files.emplace_back(*number, entry.path());
  std::ranges::sort(files);
  return files;
}

std::optional<geometry::Pose> read_matrix(std::istream& in) {
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 16; ++i)
    if (!(in >> matrix(i / 4, i % 4))) return std::nullopt;
  const Eigen::Quaterniond rotation(Eigen::Matrix3d(matrix.topLeftCorner<3, 3>()));
  if (!matrix.allFinite() || rotation.norm() < 0.5) return std::nullopt;
  return geometry::make_pose(matrix.topRightCorner<3, 1>(), rotation);
}

}  // namespace rds::recording
