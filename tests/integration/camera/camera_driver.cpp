// SPDX-License-Identifier: Apache-2.0
#include "tests/integration/camera/camera_driver.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <thread>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/geometry/lens.hpp"
#include "common/image/tum_dataset.hpp"
#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"
#include "diagnostic_msgs/msg/DiagnosticArray.h"
#include "tests/support/shared_data.hpp"

namespace rds::test {
namespace {

using rds_msgs::msg::TrackingState;
using sensor_msgs::msg::CameraInfo;
using sensor_msgs::msg::CompressedImage;
using sensor_msgs::msg::Image;

constexpr std::size_t kFrames = 40;

/// Bends less than a centre crop of the picture shows, and no coefficient is zero.
geometry::Lens bent(const geometry::CameraModel& camera, const std::string& distortion) {
  geometry::Lens lens{.width = camera.width,
                      .height = camera.height,
                      .fx = camera.fx,
                      .fy = camera.fy,
                      .cx = camera.cx,
                      .cy = camera.cy};
  if (distortion == "equidistant") {
    lens.model = geometry::LensModel::kEquidistant;
    lens.coefficients = {0.3, 0.02, -0.01, 0.003};  // near to the pinhole's tan, so that little is lost
  } else {
    lens.model = geometry::LensModel::kRationalPolynomial;
    lens.coefficients = {0.12, -0.05, 0.001, -0.001, 0.01, 0.06, -0.02, 0.004};
  }
  return lens;
}

/// Where a lens' pixel is in the pinhole camera's picture, by iteration.
cv::Mat2f places(const geometry::Lens& lens, const geometry::CameraModel& camera) {
  cv::Mat2f all(lens.height, lens.width);
  for (int y = 0; y < lens.height; ++y)
    for (int x = 0; x < lens.width; ++x) {
      Eigen::Vector3d ray((x - lens.cx) / lens.fx, (y - lens.cy) / lens.fy, 1);
      for (int i = 0; i < 10; ++i) {
        const Eigen::Vector2d off = Eigen::Vector2d(x, y) - lens.project(ray);
        ray.head<2>() += Eigen::Vector2d(off.x() / lens.fx, off.y() / lens.fy);
      }
      const Eigen::Vector2d pixel = camera.project(ray);
      all(y, x) = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
    }
  return all;
}

image::RgbdFrame through(const image::RgbdFrame& frame, const std::string& distortion) {
  static std::map<std::string, cv::Mat2f> tables;
  auto table = tables.find(distortion);
  if (table == tables.end())
    table = tables.emplace(distortion, places(bent(frame.camera, distortion), frame.camera)).first;
  image::RgbdFrame result = frame;
  cv::remap(frame.color.bgr(), result.color.pixels = cv::Mat(), table->second, cv::noArray(),
            cv::INTER_LINEAR);
  result.color.order = image::ChannelOrder::kBgr;
  cv::remap(frame.depth.values, result.depth.values = cv::Mat(), table->second, cv::noArray(),
            cv::INTER_NEAREST);
  return result;
}

Image encoded(const image::ColorImage& color, const std::string& encoding,
              const std_msgs::msg::Header& header) {
  Image message = messages::to_image_message(color, header);
  static const std::map<std::string, int> kConversions{
      {"bgra8", cv::COLOR_BGR2BGRA}, {"rgba8", cv::COLOR_BGR2RGBA}, {"mono8", cv::COLOR_BGR2GRAY}};
  if (encoding == "rgb8") return message;
  cv::Mat pixels;
  if (encoding == "bayer_rggb8") {
    const cv::Mat3b bgr = color.bgr();
    cv::Mat1b mosaic(bgr.size());
    for (int y = 0; y < bgr.rows; ++y)
      for (int x = 0; x < bgr.cols; ++x)
        mosaic(y, x) = bgr(y, x)[y % 2 == 0 ? (x % 2 == 0 ? 2 : 1) : (x % 2 == 0 ? 1 : 0)];
    pixels = mosaic;
  } else if (kConversions.contains(encoding)) {
    cv::cvtColor(color.bgr(), pixels, kConversions.at(encoding));
  } else {
    pixels = color.pixels;  // in an encoding that is said only
  }
  message.encoding(encoding);
  message.step(static_cast<std::uint32_t>(static_cast<std::size_t>(pixels.cols) * pixels.elemSize()));
  message.data().assign(pixels.datastart, pixels.dataend);
  return message;
}

CompressedImage packed(const cv::Mat& picture, const char* ending, const std::string& format,
                       std::size_t head, const std_msgs::msg::Header& header) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(ending, picture, bytes);
  bytes.insert(bytes.begin(), head, 0);
  CompressedImage message;
  message.header(header);
  message.format(format);
  message.data(std::move(bytes));
  return message;
}

cv::Mat millimetres(const image::DepthImage& depth) {
  cv::Mat values;
  depth.values.convertTo(values, CV_16U, static_cast<double>(depth.metres_per_unit) * 1000);
  return values;
}

std::vector<std::string> command(bus::Vendor vendor, int domain, const TemporaryFolder& place,
                                 const std::string& settings) {
  write_text(place / "tracker.yaml", settings);
  return {std::string(RDS_BIN_DIR) + "/rds-tracker",
          "--bus",
          name_of(vendor),
          "--domain",
          std::to_string(domain),
          "--loopback",
          "--config",
          (place / "tracker.yaml").string()};
}

}  // namespace

geometry::CameraModel half_of(geometry::CameraModel camera) {
  camera.width /= 2, camera.height /= 2, camera.fx /= 2, camera.fy /= 2;
  camera.cx /= 2, camera.cy /= 2;  // every other pixel, from the first on
  return camera;
}

geometry::Pose color_from_depth() {  // turned a little, as cameras are
  return geometry::make_pose({-0.05, 0.002, -0.001}, Eigen::Quaterniond(Eigen::AngleAxisd(
                                                         0.01, Eigen::Vector3d(1, 2, 1).normalized())));
}

image::DepthImage seen_from_depth(const image::RgbdFrame& frame, const geometry::CameraModel& camera) {
  const geometry::Pose depth_from_color = color_from_depth().inverse();
  cv::Mat1w values(camera.height, camera.width, std::uint16_t{0});
  for (int y = 0; y < frame.depth.values.rows; ++y)
    for (int x = 0; x < frame.depth.values.cols; ++x) {
      const double z = frame.depth.at(x, y);
      if (z <= 0) continue;
      const Eigen::Vector3d point = depth_from_color * (z * frame.camera.ray({x, y}));
      const Eigen::Vector2d pixel = camera.project(point);
      const cv::Point at(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())));
      if (!cv::Rect(0, 0, camera.width, camera.height).contains(at)) continue;
      const auto millimetres = static_cast<std::uint16_t>(std::lround(1000 * point.z()));
      std::uint16_t& nearest = values(at);
      if (nearest == 0 || millimetres < nearest) nearest = millimetres;
    }
  return {values, 0.001F, nullptr};
}

const std::vector<image::RgbdFrame>& TrackerWithDriver::frames() {
  static const std::vector<image::RgbdFrame> kFramesOfTheRoom = [] {
    const auto dataset = image::TumDataset::open(recording_of_a_room().folder).value();
    std::vector<image::RgbdFrame> all;
    for (const auto& frame : dataset.frames())
      if (all.size() < kFrames) all.push_back(dataset.load(frame).value());
    return all;
  }();
  return kFramesOfTheRoom;
}

std::vector<geometry::StampedPose> TrackerWithDriver::truth() {
  return image::TumDataset::open(recording_of_a_room().folder).value().ground_truth().value();
}

TrackerWithDriver::TrackerWithDriver(bus::Vendor vendor, int domain, const DriverHabits& habits,
                                     const std::string& settings)
    : habits_(habits),
      bus_(bus::Participant::create(
          {.vendor = vendor, .domain = domain, .node_name = "driver", .loopback_only = true})),
      tracker_(command(vendor, domain, place_, settings)) {
  const bus::Qos qos = habits.best_effort ? bus::kSensorBestEffort : bus::kSensor;
  if (!habits.info_topic.empty()) info_ = bus_->advertise<CameraInfo>(habits.info_topic, qos);
  if (habits.compressed) {
    packed_color_ = bus_->advertise<CompressedImage>(habits.color_topic + "/compressed", qos);
    packed_depth_ = bus_->advertise<CompressedImage>(habits.depth_topic + "/compressedDepth", qos);
  } else {
    if (!habits.color_topic.empty()) color_ = bus_->advertise<Image>(habits.color_topic, qos);
    if (!habits.depth_topic.empty()) depth_ = bus_->advertise<Image>(habits.depth_topic, qos);
  }
  if (habits.half_depth || habits.depth_apart)
    depth_info_ = bus_->advertise<CameraInfo>("camera/aligned_depth_to_color/camera_info", qos);
  subscriptions_.push_back(
      bus_->subscribe<TrackingState>("rds/tracking_state", bus::kStream, [this](const auto& m) {
        const std::lock_guard lock(mutex_);
        states_.push_back(*m);
        changed_.notify_all();
      }));
  subscriptions_.push_back(bus_->subscribe<diagnostic_msgs::msg::DiagnosticArray>(
      "diagnostics", bus::kStream, [this](const auto& m) {
        const std::lock_guard lock(mutex_);
        for (const auto& status : m->status())
          if (status.name() == "rds-tracker") diagnosis_ = status.message();
      }));
  frames();
  // The tracker has its endpoints, and this side knows them.
  const auto end = std::chrono::steady_clock::now() + 20s;
  const auto is_there = [&] {
    const auto endpoints = bus_->discovered();
    return std::ranges::any_of(endpoints,
                               [](const auto& e) { return e.topic == "rds/tracking_state" && e.publisher; });
  };
  while (!is_there() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(20ms);
  if (habits.depth_apart) publish_mounting();
}

void TrackerWithDriver::publish(const image::RgbdFrame& given, std::int64_t stamp_ns) {
  const bool is_bent = habits_.distortion != "plumb_bob";
  const image::RgbdFrame frame = is_bent ? through(given, habits_.distortion) : given;
  const auto header = messages::make_header(stamp_ns, habits_.frame);
  const auto depth_header = messages::make_header(stamp_ns + habits_.depth_delay_ns, habits_.depth_frame);
  CameraInfo info = messages::to_camera_info(frame.camera, header);
  if (is_bent) {
    const geometry::Lens lens = bent(frame.camera, habits_.distortion);
    info.distortion_model(habits_.distortion);
    info.d().assign(lens.coefficients.begin(),
                    lens.coefficients.begin() + (habits_.distortion == "equidistant" ? 4 : 8));
  }
  if (!habits_.info_topic.empty()) info_.write(info);
  if (habits_.compressed) {
    packed_color_.write(packed(frame.color.bgr(), ".jpg", "rgb8; jpeg compressed bgr8", 0, header));
    packed_depth_.write(
        packed(millimetres(frame.depth), ".png", "16UC1; compressedDepth png", 12, depth_header));
    return;
  }
  if (!habits_.color_topic.empty()) color_.write(encoded(frame.color, habits_.encoding, header));
  if (habits_.depth_topic.empty()) return;
  publish_depth(frame, stamp_ns + habits_.depth_delay_ns);
}

void TrackerWithDriver::publish_depth(const image::RgbdFrame& frame, std::int64_t stamp_ns) {
  const auto header = messages::make_header(stamp_ns, habits_.depth_frame);
  image::DepthImage depth = frame.depth;
  if (habits_.half_depth || habits_.depth_apart) {
    const geometry::CameraModel half = half_of(frame.camera);
    depth_info_.write(messages::to_camera_info(half, header));
    if (habits_.depth_apart)
      depth = seen_from_depth(frame, half);
    else
      cv::resize(frame.depth.values, depth.values = cv::Mat(), {half.width, half.height}, 0, 0,
                 cv::INTER_NEAREST);
  }
  depth_.write(messages::to_image_message(depth, header));
}

/// Where depth's camera is; returns when the tracker has read it.
void TrackerWithDriver::publish_mounting() {
  geometry_msgs::msg::TransformStamped mounting;
  mounting.header(messages::make_header(0, habits_.frame));
  mounting.child_frame_id(habits_.depth_frame);
  mounting.transform(messages::to_transform_message(color_from_depth()));
  static_ = bus_->advertise<tf2_msgs::msg::TFMessage>("tf_static", bus::kLatched);
  tf2_msgs::msg::TFMessage tree;
  tree.transforms().push_back(mounting);
  static_.write(tree);
  std::this_thread::sleep_for(500ms);
}

bool TrackerWithDriver::publish_until(const std::function<bool()>& condition, std::chrono::seconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  constexpr std::int64_t kPeriodNs = 50'000'000;
  for (std::int64_t i = 0; std::chrono::steady_clock::now() < end; ++i) {
    if (condition()) return true;
    // There and back again, so that the camera does not jump.
    const auto last = static_cast<std::int64_t>(frames().size()) - 1;
    const std::int64_t place = i % (2 * last);
    publish(frames()[static_cast<std::size_t>(place <= last ? place : 2 * last - place)],
            frames()[0].stamp_ns + i * kPeriodNs);
    std::this_thread::sleep_for(std::chrono::nanoseconds(kPeriodNs));
  }
  return condition();
}

TrackingState TrackerWithDriver::track(std::size_t index) {
  const auto answer = [&] {
    return std::ranges::find_if(states_, [&](const TrackingState& state) {
      return messages::to_nanoseconds(state.header().stamp()) == frames()[index].stamp_ns;
    });
  };
  constexpr int kTries = 10;  // at first a reader may not have found its topic yet
  for (int i = 0; i < kTries; ++i) {
    publish(frames().at(index), frames()[index].stamp_ns);
    std::unique_lock lock(mutex_);
    if (changed_.wait_for(lock, 2s, [&] { return answer() != states_.end(); })) return *answer();
  }
  throw std::runtime_error("frame " + std::to_string(index) + " was not acknowledged: " + log());
}

std::string TrackerWithDriver::diagnosis() {
  const std::lock_guard lock(mutex_);
  return diagnosis_;
}

std::size_t TrackerWithDriver::tracked() {
  const std::lock_guard lock(mutex_);
  return static_cast<std::size_t>(std::ranges::count_if(
      states_, [](const TrackingState& s) { return s.state() == 1 || s.state() == 2; }));
}

}  // namespace rds::test
