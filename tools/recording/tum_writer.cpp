// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/imgcodecs.hpp>

#include "common/geometry/stamp.hpp"
#include "common/geometry/trajectory.hpp"
#include "common/image/sensors/imu_file.hpp"
#include "tools/recording/conversion.hpp"

namespace rds::recording {
namespace fs = std::filesystem;
namespace {

using Result = tl::expected<void, std::string>;

constexpr double kMillimetresPerMetre = 1000;

Result write_picture(const fs::path& file, const cv::Mat& picture) {
  constexpr int kFast = 1;
  bool written = false;
  try {
    written = cv::imwrite(file.string(), picture, {cv::IMWRITE_PNG_COMPRESSION, kFast});
  } catch (const cv::Exception&) {
    written = false;
  }
  if (!written) return tl::unexpected(file.string() + ": cannot be written");
  return {};
}

Result write_text(const fs::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) return tl::unexpected(file.string() + ": cannot be written");
  return {};
}

std::string camera_yaml(const image::Recording& recording, double depth_scale) {
  const auto& c = recording.camera();
  return fmt::format(
      "width: {}\nheight: {}\nfx: {}\nfy: {}\ncx: {}\ncy: {}\ndistortion: [{}]  # k1 k2 p1 p2 k3\n"
      "depth_scale: {}  # units per metre; 0: no measurement\nfps: {}\n",
      c.width, c.height, c.fx, c.fy, c.cx, c.cy, fmt::join(c.distortion, ", "), depth_scale, recording.fps());
}

/// A recording on its way into a folder.
class TumFolder {
 public:
  TumFolder(const image::Recording& recording, fs::path folder)
      : recording_(recording), folder_(std::move(folder)) {}

  Result write_pictures() {
    std::error_code error;
    for (const char* name : {"rgb", "depth"})
      if (!fs::create_directories(folder_ / name, error) && error)
        return tl::unexpected(
            fmt::format("{}: cannot be made: {}", (folder_ / name).string(), error.message()));
    for (const auto& frame : recording_.frames())
      if (const auto done = write_color(frame); !done) return done;
    for (std::size_t i = 0; i < recording_.depth_stamps().size(); ++i)
      if (const auto done = write_depth(i); !done) return done;
    return {};
  }
  /// Last, so that a folder that was not finished is not taken for a recording.
  Result write_lists() const {
    if (recording_.ground_truth())
      if (auto done = geometry::write_trajectory(folder_ / "groundtruth.txt", *recording_.ground_truth());
          !done)
        return done;
    if (auto done = write_sensors(); !done) return done;
    for (const auto& [name, text] : {std::pair("camera.yaml", camera_yaml(recording_, depth_scale_)),
                                     std::pair("depth.txt", depth_list_), std::pair("rgb.txt", color_list_)})
      if (auto done = write_text(folder_ / name, text); !done) return done;
    return {};
  }
  [[nodiscard]] const Converted& converted() const { return converted_; }

 private:
  Result write_sensors() const {
    const auto& [imu, odometry] = recording_.sensors();
    if (imu)
      if (auto done = write_text(folder_ / "imu.txt", image::imu_lines(*imu)); !done) return done;
    if (!odometry) return {};
    auto of_camera = odometry->odom_from_body;
    for (auto& pose : of_camera) pose.map_from_camera = pose.map_from_camera * odometry->body_from_camera;
    return geometry::write_trajectory(folder_ / "odometry.txt", of_camera);
  }
  Result write_color(const image::FrameRef& frame) {
    const auto color = recording_.load_color(frame.index);
    if (!color) return note_unreadable(color.error());
    const std::string name = fmt::format("rgb/{}.png", frame.stamp_text);
    color_list_ += fmt::format("{} {}\n", frame.stamp_text, name);
    ++converted_.items;
    return write_picture(folder_ / name, color->bgr());
  }
  Result write_depth(std::size_t index) {
    const auto depth = recording_.load_depth(index);
    if (!depth) return note_unreadable(depth.error());
    const std::string stamp = geometry::format_stamp(recording_.depth_stamps()[index]);
    const std::string name = fmt::format("depth/{}.png", stamp);
    depth_list_ += fmt::format("{} {}\n", stamp, name);
    ++converted_.items;
    cv::Mat values = depth->values;
    if (values.type() == CV_16UC1) {
      depth_scale_ = recording_.depth_scale();
    } else {
      depth_scale_ = kMillimetresPerMetre;
      cv::patchNaNs(values = values.clone(), 0);
      values.convertTo(values, CV_16UC1, kMillimetresPerMetre * static_cast<double>(depth->metres_per_unit));
    }
    return write_picture(folder_ / name, values);
  }
  Result note_unreadable(const std::string& sentence) {
    if (converted_.unreadable++ == 0) converted_.fault = sentence;
    return {};
  }

  const image::Recording& recording_;
  fs::path folder_;
  std::string color_list_ = "# timestamp filename\n";
  std::string depth_list_ = "# timestamp filename\n";
  double depth_scale_ = kMillimetresPerMetre;
  Converted converted_;
};

}  // namespace

tl::expected<Converted, std::string> write_tum_folder(const image::Recording& recording,
                                                      const fs::path& folder) {
  TumFolder out(recording, folder);
  if (const auto done = out.write_pictures(); !done) return tl::unexpected(done.error());
  if (const auto done = out.write_lists(); !done) return tl::unexpected(done.error());
  return out.converted();
}

}  // namespace rds::recording
