// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/bag_seeds.hpp"

#include <stdexcept>

#include <opencv2/imgcodecs.hpp>

#include "common/messages/conversions.hpp"
#include "sensor_msgs/msg/CompressedImage.h"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/recording/camera_messages.hpp"
#include "tools/recording/conversion.hpp"
#include "tools/recording/open_recording.hpp"

namespace rds::fuzz {
namespace {

namespace fs = std::filesystem;
using recording::BagWriter;
using sensor_msgs::msg::CompressedImage;

constexpr std::size_t kDepthHead = 12;  // bytes before the PNG of compressedDepth

template <class Value, class Error>
Value good(tl::expected<Value, Error> made) {
  if (!made) throw std::runtime_error(made.error());
  return std::move(*made);
}

Bytes bytes_of(const fs::path& file) {
  const std::string bytes = test::read_text(file);
  return {bytes.begin(), bytes.end()};
}

template <class Message>
void write(BagWriter& bag, std::size_t topic, const Message& message, std::int64_t stamp_ns) {
  const auto& type = bus::type_ops<Message>();
  Bytes bytes(type.encoded_size(&message));
  bytes.resize(type.encode(&message, bytes.data(), bytes.size()));
  if (!bag.write(topic, {stamp_ns, stamp_ns, bytes})) throw std::runtime_error("the seed cannot be written");
}

CompressedImage compressed(const cv::Mat& picture, const std::string& format, std::int64_t stamp_ns,
                           std::size_t head) {
  Bytes bytes;
  cv::imencode(".png", picture, bytes);
  bytes.insert(bytes.begin(), head, 0);
  CompressedImage message;
  message.header(messages::make_header(stamp_ns, "camera"));
  message.format(format);
  message.data(bytes);
  return message;
}

void write_compressed(const image::Recording& of, BagWriter& bag) {
  const auto add = [&](const char* name, const bus::TypeOps& type) {
    return good(bag.add_topic(recording::topic_of(name, type, "")));
  };
  const auto color = add("/cam/rgb/image_raw/compressed", bus::type_ops<CompressedImage>());
  const auto depth = add("/cam/depth/image/compressedDepth", bus::type_ops<CompressedImage>());
  const auto info = add("/cam/rgb/camera_info", bus::type_ops<sensor_msgs::msg::CameraInfo>());
  for (const auto& frame : of.frames()) {
    const std::int64_t stamp_ns = frame.stamp_ns;
    const auto pictures = good(of.load(frame));
    write(bag, info, recording::camera_info_message(of.camera(), stamp_ns), stamp_ns);
    write(bag, color, compressed(pictures.color.pixels, "bgr8; png compressed bgr8", stamp_ns, 0), stamp_ns);
    cv::Mat1w millimetres;
    pictures.depth.values.convertTo(millimetres, CV_16U);
    write(bag, depth, compressed(millimetres, "16UC1; compressedDepth png", stamp_ns, kDepthHead), stamp_ns);
  }
  if (!bag.finish()) throw std::runtime_error("the seed cannot be finished");
}

}  // namespace

std::vector<Bytes> bag_seeds(const fs::path& folder, const std::string& ending) {
  const fs::path tum = folder / "tum";
  const fs::path file = folder / ("seed." + ending);
  test::make_small_dataset(tum, 3);
  test::write_text(tum / "odometry.txt", "10 0 0 0 0 0 0 1\n10.1 0.5 0 0 0 0 0 1\n");
  test::write_text(tum / "imu.txt", "9.9 0.5 -9.75 0 0.125 0.25 0.5\n10.2 0 -9.8 0 0 0 1\n");
  const auto source = std::move(good(recording::open_recording(tum)).recording);
  using enum mcap::Compression;
  std::vector<Bytes> seeds;
  for (const auto compression : {kLz4, kZstd, kNone}) {
    if (ending != "mcap" && compression != kLz4) continue;
    good(recording::write_bag(*source, *good(recording::make_bag_writer(file, compression))));
    seeds.push_back(bytes_of(file));
  }
  write_compressed(*source, *good(recording::make_bag_writer(file, kNone)));
  seeds.push_back(bytes_of(file));
  return seeds;
}

}  // namespace rds::fuzz
