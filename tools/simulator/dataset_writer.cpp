// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/dataset_writer.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "common/image/sensors/imu_file.hpp"
#include "tools/simulator/sensors/dead_reckoning.hpp"
#include "tools/simulator/sensors/inertial_unit.hpp"
#include "tools/simulator/truth_map.hpp"

namespace rds::simulator {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kStart = 1.0;       // stamp of the first frame [s]
constexpr int kPosesPerFrame = 4;    // groundtruth.txt has 120 lines a second
constexpr double kImuPathHz = 400;   // twice as often as the unit measures, so that it is exact
constexpr double kImuLongerS = 0.1;  // than the pictures: the last of them waits for no measurement
constexpr int kJpegQuality = 92;
constexpr std::array kEntries{"rgb",         "depth",           "masks",        "rgb.txt",
                              "depth.txt",   "groundtruth.txt", "odometry.txt", "imu.txt",
                              "camera.yaml", "people.json",     "objects.json", "detections_truth.jsonl",
                              "truth.ot"};

/// As short as it is exact, with a point: 525.0, 347.8125.
std::string decimal(double value) {
  std::string text = fmt::format("{}", value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

/// Rounded for the file, so that the last binary digits do not show.
Json number(double value, int digits) {
  return std::stod(fmt::format("{:.{}f}", value, digits));
}

Json vector(const Eigen::Vector3d& v, int digits) {
  return {number(v.x(), digits), number(v.y(), digits), number(v.z(), digits)};
}

std::string lines_of(const std::vector<geometry::StampedPose>& path) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (const auto& [stamp_ns, pose, stamp] : path) {
    const Eigen::Quaterniond q(pose.linear());
    const Eigen::Vector3d p = pose.translation();
    text += fmt::format("{} {:.6f} {:.6f} {:.6f} {:.7f} {:.7f} {:.7f} {:.7f}\n", stamp, p.x(), p.y(), p.z(),
                        q.x(), q.y(), q.z(), q.w());
  }
  return text;
}

void write_image(const fs::path& path, const cv::Mat& image, const std::vector<int>& parameters) {
  bool written = false;
  try {
    written = cv::imwrite(path.string(), image, parameters);
  } catch (const cv::Exception&) {
    written = false;
  }
  if (!written) throw std::runtime_error(path.string() + ": cannot be written");
}

}  // namespace

void prepare_folder(const fs::path& folder, bool force) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    throw std::runtime_error(folder.string() + ": is a file, expected a folder to write the recording into");
  if (fs::exists(folder / "rgb.txt", error) || fs::exists(folder / "rgb", error)) {
    if (!force)
      throw std::runtime_error(folder.string() + ": holds a recording already; --force overwrites it");
    for (const char* name : kEntries) fs::remove_all(folder / name, error);
  }
  for (const char* name : {"rgb", "depth", "masks"})
    if (!fs::create_directories(folder / name, error) && error)
      throw std::runtime_error((folder / name).string() + ": cannot be made (" + error.message() + ")");
}

DatasetWriter::DatasetWriter(const Simulation& simulation, fs::path folder)
    : simulation_(simulation),
      folder_(std::move(folder)),
      people_(static_cast<std::size_t>(simulation.frame_count())),
      visible_(people_.size()) {}

std::string DatasetWriter::stamp(int index) const {
  return fmt::format("{:.6f}", kStart + simulation_.time_s(index));
}

void DatasetWriter::write(int index, const SimulatedFrame& frame) {
  const std::string name = stamp(index);
  write_image(folder_ / "rgb" / (name + ".jpg"), frame.color, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  write_image(folder_ / "depth" / (name + ".png"), frame.depth, {cv::IMWRITE_PNG_COMPRESSION, 3});
  write_image(folder_ / "masks" / (name + ".png"), frame.mask, {cv::IMWRITE_PNG_COMPRESSION, 3});
  people_[static_cast<std::size_t>(index)] = frame.people;
  visible_[static_cast<std::size_t>(index)] = frame.visible;
}

void DatasetWriter::write_text(const std::string& name, const std::string& text) const {
  std::ofstream file(folder_ / name, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error((folder_ / name).string() + ": cannot be written");
}

/// world_from_camera, 120 times a second.
std::vector<geometry::StampedPose> DatasetWriter::path() const {
  std::vector<geometry::StampedPose> path;
  const int last = (simulation_.frame_count() - 1) * kPosesPerFrame;
  for (int i = 0; i <= last; ++i) {
    const double t = i / (simulation_.options().rate_hz * kPosesPerFrame);
    path.push_back({std::llround((kStart + t) * 1e9), simulation_.world_from_camera(t),
                    fmt::format("{:.6f}", kStart + t)});
  }
  return path;
}

std::string DatasetWriter::groundtruth() const {
  return "# ground truth of the camera, exact: world_from_camera, z up\n" + lines_of(path());
}

std::string DatasetWriter::odometry() const {
  DeadReckoningErrors errors;
  errors.scale = *simulation_.options().odometry_scale;
  return fmt::format("# odometry of the camera, with scale {}, noise and slip: odom_from_camera\n",
                     errors.scale) +
         lines_of(dead_reckoning(path(), errors, simulation_.options().seed));
}

std::string DatasetWriter::imu() const {
  std::vector<geometry::StampedPose> path;
  const double seconds = simulation_.time_s(simulation_.frame_count() - 1) + kImuLongerS;
  for (int i = 0; i <= seconds * kImuPathHz; ++i) {
    const double t = i / kImuPathHz;
    path.push_back({std::llround((kStart + t) * 1e9), simulation_.world_from_camera(t), ""});
  }
  return image::imu_lines(inertial_unit(path, {}, simulation_.options().seed));
}

std::string DatasetWriter::people() const {
  const auto& options = simulation_.options();
  const Json meta{{"made_by", "rds simulate"},  {"seed", options.seed},     {"walkers", options.people},
                  {"seconds", options.seconds}, {"frames", people_.size()}, {"up", {0, 0, 1}}};
  std::string text = "{\"meta\": " + meta.dump() + ",\n\"frames\": [\n";
  for (std::size_t i = 0; i < people_.size(); ++i) {
    const std::string name = stamp(static_cast<int>(i));
    Json list = Json::array();
    for (const auto& p : people_[i])
      list.push_back({{"id", p.id},
                      {"box", {p.box.x, p.box.y, p.box.br().x, p.box.br().y}},
                      {"visible_fraction", number(p.visible_fraction, 4)},
                      {"area", p.area},
                      {"center_world", vector(p.center_world, 4)},
                      {"velocity_world", vector(p.velocity_world, 3)},
                      {"distance", number(p.distance, 3)},
                      {"motion", p.motion},
                      {"moving", p.velocity_world.norm() > 0.1},
                      {"sprite", fmt::format("person{}", p.id)}});
    const Json frame{{"timestamp", name}, {"file", "rgb/" + name + ".jpg"}, {"people", list}};
    text += frame.dump() + (i + 1 < people_.size() ? ",\n" : "\n");
  }
  return text + "]}\n";
}

std::string DatasetWriter::objects() const {
  std::string text;
  int id = 0;
  for (const auto& object : simulation_.scene().objects) {
    if (object.label.empty()) continue;
    const Json line{{"id", id++},
                    {"label", object.label},
                    {"center", vector(object.box.center(), 4)},
                    {"size", vector(object.box.size(), 4)},
                    {"oriented",
                     {{"center", vector(object.center_when_turned(), 4)},
                      {"size", vector(object.box_when_turned.size(), 4)},
                      {"yaw", number(object.yaw_rad, 4)}}}};
    text += (text.empty() ? "[\n" : ",\n") + line.dump();
  }
  return text + "\n]\n";
}

std::string DatasetWriter::detections() const {
  std::string text;
  for (std::size_t i = 0; i < visible_.size(); ++i) {
    Json list = Json::array();
    for (const auto& v : visible_[i])
      list.push_back({{"label", v.label},
                      {"score", 1.0},
                      {"box", {v.box.x, v.box.y, v.box.br().x, v.box.br().y}},
                      {"depth_m", number(v.depth_m, 4)}});
    const Json line{{"stamp", std::stod(stamp(static_cast<int>(i)))}, {"detections", list}};
    text += line.dump() + "\n";
  }
  return text;
}

std::string DatasetWriter::camera() const {
  const auto& c = simulation_.options().camera;
  const auto& d = c.distortion;
  return fmt::format(
      "# Simulated camera. Pinhole, {} distortion, depth registered to colour.\nwidth: {}\nheight: {}\nfx: "
      "{}\nfy: {}\ncx: {}\ncy: {}\n"
      "distortion: [{}, {}, {}, {}, {}]   # k1 k2 p1 p2 k3\ndepth_scale: {}   # raw depth units per "
      "metre; 0 = no measurement\nfps: {}\n",
      c.has_distortion() ? "radial-tangential" : "no", c.width, c.height, decimal(c.fx), decimal(c.fy),
      decimal(c.cx), decimal(c.cy), decimal(d[0]), decimal(d[1]), decimal(d[2]), decimal(d[3]), decimal(d[4]),
      decimal(simulation_.options().depth_units_per_metre), simulation_.options().rate_hz);
}

void DatasetWriter::finish() const {
  if (simulation_.options().world == World::kFloor)
    write_truth_map(simulation_.scene(), folder_ / "truth.ot");
  write_text("camera.yaml", camera());
  write_text("groundtruth.txt", groundtruth());
  if (simulation_.options().odometry_scale) write_text("odometry.txt", odometry());
  if (simulation_.options().imu) write_text("imu.txt", imu());
  write_text("people.json", people());
  write_text("objects.json", objects());
  write_text("detections_truth.jsonl", detections());
  std::string depth = "# depth maps\n# timestamp filename\n";
  std::string rgb = "# color images\n# timestamp filename\n";
  for (int i = 0; i < simulation_.frame_count(); ++i) {
    depth += fmt::format("{0} depth/{0}.png\n", stamp(i));
    rgb += fmt::format("{0} rgb/{0}.jpg\n", stamp(i));
  }
  write_text("depth.txt", depth);
  write_text("rgb.txt", rgb);
}

}  // namespace rds::simulator
