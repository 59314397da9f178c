// SPDX-License-Identifier: Apache-2.0
// A recording is the same in every form: what a camera would publish of it is, byte for byte.
#include <algorithm>

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

#include "common/bus/type_ops.hpp"
#include "common/image/tum_dataset.hpp"
#include "common/messages/image_conversions.hpp"
#include "sensor_msgs/msg/CompressedImage.h"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/recording/bag_recording.hpp"
#include "tools/recording/camera_messages.hpp"
#include "tools/recording/conversion.hpp"
#include "tools/recording/open_recording.hpp"

namespace rds::recording {
namespace {

namespace fs = std::filesystem;
using sensor_msgs::msg::CompressedImage;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

template <class Message>
Bytes encoded(const Message& message) {
  const auto& type = bus::type_ops<Message>();
  Bytes bytes(type.encoded_size(&message));
  bytes.resize(type.encode(&message, bytes.data(), bytes.size()));
  return bytes;
}

/// What is published of each frame: stamp of depth, colour, depth, camera_info.
using Published = std::vector<std::tuple<std::int64_t, Bytes, Bytes, Bytes>>;

Published published(const image::Recording& recording) {
  Published all;
  for (const auto& ref : recording.frames()) {
    const auto frame = recording.load(ref);
    if (!frame) continue;
    all.emplace_back(ref.depth_stamp_ns, encoded(color_message(frame->color, ref.stamp_ns)),
                     encoded(depth_message(frame->depth, ref.depth_stamp_ns)),
                     encoded(camera_info_message(frame->camera, ref.stamp_ns)));
  }
  return all;
}

std::vector<std::string> stamp_texts(const image::Recording& recording) {
  std::vector<std::string> texts;
  for (const auto& frame : recording.frames()) texts.push_back(frame.stamp_text);
  return texts;
}

/// Topic, log time and data of all messages of a bag.
std::vector<std::tuple<std::string, std::int64_t, Bytes>> messages_of(const fs::path& path) {
  std::vector<std::tuple<std::string, std::int64_t, Bytes>> all;
  const auto bag = open_bag(path);
  EXPECT_TRUE(bag) << bag.error();
  const auto scan = (*bag)->scan([&](const BagTopic& topic, const BagMessage& m, const BagPlace& place) {
    all.emplace_back(topic.name, m.log_time_ns, Bytes(m.data.begin(), m.data.end()));
    EXPECT_EQ((*bag)->data_at(place), std::get<2>(all.back()));
  });
  EXPECT_TRUE(scan) << scan.error();
  EXPECT_THAT(scan->fault, IsEmpty());
  return all;
}

class RecordingForms : public testing::Test {
 protected:
  void SetUp() override {
    test::make_small_dataset(tum, 6);
    // Depth in fifths of millimetres, later than colour; one frame without it, and one depth picture too
    // many.
    std::string camera = test::read_text(tum / "camera.yaml");
    camera.replace(camera.find("depth_scale: 1000"), 17, "depth_scale: 5000");
    test::write_text(tum / "camera.yaml", camera);
    test::write_text(tum / "depth.txt",
                     "10.008 depth/10.000000.png\n10.041 depth/10.033333.png\n10.045 depth/10.066667.png\n"
                     "10.108 depth/10.100000.png\n10.141 depth/10.133333.png\n10.174 depth/10.166667.png\n");
  }
  void expect_same(const fs::path& path) const {
    const auto opened = open_recording(path);
    ASSERT_TRUE(opened) << opened.error();
    const auto original = image::TumDataset::open(tum).value();
    EXPECT_EQ(published(*opened->recording), published(original));
    EXPECT_EQ(stamp_texts(*opened->recording), stamp_texts(original));
    EXPECT_EQ(opened->recording->camera(), original.camera());
    EXPECT_EQ(opened->recording->fps(), original.fps());
    EXPECT_EQ(opened->recording->without_depth(), original.without_depth());
    ASSERT_TRUE(opened->recording->ground_truth());
    ASSERT_EQ(opened->recording->ground_truth()->size(), original.ground_truth()->size());
    for (std::size_t i = 0; i < original.ground_truth()->size(); ++i) {
      const auto& pose = (*opened->recording->ground_truth())[i];
      EXPECT_EQ(pose.stamp_ns, (*original.ground_truth())[i].stamp_ns);
      EXPECT_TRUE(pose.map_from_camera.isApprox((*original.ground_truth())[i].map_from_camera, 1e-9));
    }
  }
  fs::path convert_to_bag(const std::string& name,
                          mcap::Compression compression = mcap::Compression::kLz4) const {
    auto writer = make_bag_writer(folder / name, compression).value();
    const auto done = write_bag(image::TumDataset::open(tum).value(), *writer);
    EXPECT_TRUE(done) << done.error();
    EXPECT_EQ(done->unreadable, 0U);
    EXPECT_EQ(done->items, 6U + 6U + 6U + 6U);
    return folder / name;
  }
  test::TemporaryFolder folder;
  fs::path tum = folder / "tum";
};

TEST_F(RecordingForms, McapIsAsTheFolder) {
  for (const auto compression : {mcap::Compression::kNone, mcap::Compression::kLz4, mcap::Compression::kZstd})
    expect_same(convert_to_bag("a.mcap", compression));
}

TEST_F(RecordingForms, SqliteIsAsTheFolder) {
  expect_same(convert_to_bag("a.db3"));
}

TEST_F(RecordingForms, AFolderMadeOfABagIsAsTheFolder) {
  const auto bag = open_recording(convert_to_bag("a.mcap")).value();
  const auto done = write_tum_folder(*bag.recording, folder / "again");
  ASSERT_TRUE(done) << done.error();
  expect_same(folder / "again");
}

TEST_F(RecordingForms, WhatTheRobotHasSensedIsInAllOfThem) {
  test::write_text(tum / "odometry.txt", "10 0 0 0 0 0 0 1\n10.1 0.5 0 0 0 0 0 1\n");
  test::write_text(tum / "imu.txt", "9.9 0.5 -9.75 0 0.125 0.25 0.5\n10.2 0 -9.8 0 0 0 1\n");
  const auto expect_sensors = [](const image::Recording& recording) {
    const auto& [imu, odometry] = recording.sensors();
    ASSERT_TRUE(imu && odometry);
    EXPECT_TRUE(imu->has_gyroscope);
    ASSERT_EQ(imu->measurements.size(), 2U);
    EXPECT_EQ(imu->measurements[0].stamp_ns, 9'900'000'000);
    EXPECT_EQ(imu->measurements[0].acceleration, Eigen::Vector3d(0.5, -9.75, 0));
    EXPECT_EQ(imu->measurements[0].turn_rate, Eigen::Vector3d(0.125, 0.25, 0.5));
    ASSERT_EQ(odometry->odom_from_body.size(), 2U);
    EXPECT_EQ(odometry->odom_from_body[1].stamp_ns, 10'100'000'000);
    EXPECT_EQ(odometry->odom_from_body[1].map_from_camera.translation().x(), 0.5);
  };
  for (const char* name : {"a.mcap", "a.db3"}) {
    auto writer = make_bag_writer(folder / name, mcap::Compression::kLz4).value();
    ASSERT_TRUE(write_bag(image::TumDataset::open(tum).value(), *writer));
    const auto opened = open_recording(folder / name);
    ASSERT_TRUE(opened) << opened.error();
    EXPECT_THAT(opened->notes, AllOf(HasSubstr("IMU /imu"), HasSubstr("odometry /odom")));
    expect_sensors(*opened->recording);
    const fs::path again = folder / (std::string(name) + "_again");
    ASSERT_TRUE(write_tum_folder(*opened->recording, again));
    expect_sensors(image::TumDataset::open(again).value());
  }
}

TEST_F(RecordingForms, AFolderOfRosbag2NamesItsFiles) {
  const fs::path bag = folder / "bag";
  fs::create_directories(bag);
  fs::rename(convert_to_bag("a.mcap"), bag / "bag_0.mcap");
  test::write_text(
      bag / "metadata.yaml",
      "rosbag2_bagfile_information:\n  version: 8\n  storage_identifier: mcap\n  compression_mode: \"\"\n"
      "  relative_file_paths:\n    - bag_0.mcap\n");
  expect_same(bag);
  test::write_text(
      bag / "metadata.yaml",
      "rosbag2_bagfile_information:\n  compression_mode: FILE\n  relative_file_paths: [bag_0.mcap]\n");
  EXPECT_THAT(open_recording(bag).error(), AllOf(HasSubstr("metadata.yaml"), HasSubstr("compressed")));
  test::write_text(bag / "metadata.yaml",
                   "rosbag2_bagfile_information: {relative_file_paths: [none.mcap]}\n");
  EXPECT_THAT(open_recording(bag).error(), HasSubstr("none.mcap"));
}

TEST_F(RecordingForms, BagsAreCopiedByteForByte) {
  const fs::path first = convert_to_bag("a.mcap");
  fs::path from = first;
  for (const char* name : {"b.db3", "c.mcap"}) {
    auto writer = make_bag_writer(folder / name, mcap::Compression::kZstd).value();
    auto bag = open_bag(from).value();
    ASSERT_TRUE(copy_bag(*bag, *writer));
    from = folder / name;
    EXPECT_EQ(messages_of(from), messages_of(first));
  }
}

TEST_F(RecordingForms, ATornBagGivesWhatIsLeft) {
  test::make_small_dataset(tum, 150);  // more than one chunk
  const fs::path file = folder / "a.mcap";
  auto writer = make_bag_writer(file, mcap::Compression::kNone).value();
  ASSERT_TRUE(write_bag(image::TumDataset::open(tum).value(), *writer));
  fs::resize_file(file, fs::file_size(file) * 3 / 4);
  const auto opened = open_recording(file);
  ASSERT_TRUE(opened) << opened.error();
  EXPECT_THAT(opened->notes, HasSubstr("a.mcap: torn after"));
  EXPECT_GT(opened->recording->frames().size(), 60U);
  EXPECT_LT(opened->recording->frames().size(), 150U);
}

/// A camera of another make: its own names, compressed pictures, depth in metres.
class ForeignBag : public testing::Test {
 protected:
  template <class Message>
  void add(const std::string& topic, const Message& message) {
    const auto known = std::ranges::find(names_, topic);
    const auto number = static_cast<std::size_t>(known - names_.begin());
    if (known == names_.end()) {
      names_.push_back(topic);
      EXPECT_EQ(writer_->add_topic(topic_of(topic, bus::type_ops<Message>(), "")).value(), number);
    }
    EXPECT_TRUE(writer_->write(number, {++time_, time_, encoded(message)}));
  }
  static CompressedImage compressed(const cv::Mat& picture, const char* ending, const std::string& format,
                                    std::int64_t stamp_ns, std::size_t head = 0) {
    CompressedImage message;
    std::vector<std::uint8_t> bytes;
    cv::imencode(ending, picture, bytes);
    bytes.insert(bytes.begin(), head, 0);
    message.header().stamp(messages::to_time(stamp_ns));
    message.format(format);
    message.data(bytes);
    return message;
  }
  auto open() {
    EXPECT_TRUE(writer_->finish());
    return open_recording(folder / "a.mcap");
  }
  test::TemporaryFolder folder;
  geometry::CameraModel camera{.width = 32, .height = 24, .fx = 30, .fy = 30, .cx = 15.5, .cy = 11.5};
  cv::Mat color{24, 32, CV_8UC3, cv::Scalar(10, 20, 30)};
  cv::Mat1w depth = cv::Mat1w(24, 32, std::uint16_t{1234});  // braces would make a list

 private:
  std::unique_ptr<BagWriter> writer_ = make_bag_writer(folder / "a.mcap", mcap::Compression::kLz4).value();
  std::vector<std::string> names_;
  std::int64_t time_ = 0;
};

TEST_F(ForeignBag, TopicsAreFoundByTheirTypes) {
  for (std::int64_t i = 1; i <= 3; ++i) {
    add("/infra/image_rect_raw", color_message({color, image::ChannelOrder::kRgb, nullptr}, i));
    add("/front/rgb/info", camera_info_message({.width = 5, .height = 5, .fx = 1, .fy = 1}, i));
    add("/front/rgb/image_color/compressed",
        compressed(color, ".png", "rgb8; png compressed bgr8", i * 33'000'000));
    add("/front/registered/image/compressedDepth",
        compressed(depth, ".png", "16UC1; compressedDepth png", i * 33'000'000 + 5, 12));
    add("/front/rgb/camera_info", camera_info_message(camera, i));
  }
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error();
  EXPECT_THAT(opened->notes, AllOf(HasSubstr("colour /front/rgb/image_color/compressed"),
                                   HasSubstr("depth /front/registered/image/compressedDepth")));
}

TEST_F(ForeignBag, CompressedPicturesAreDecoded) {
  for (std::int64_t i = 1; i <= 3; ++i) {
    add("/cam/rgb/image_raw/compressed",
        compressed(color, ".png", "rgb8; png compressed bgr8", i * 33'000'000));
    add("/cam/depth/compressedDepth",
        compressed(depth, ".png", "16UC1; compressedDepth png", i * 33'000'000 + 5, 12));
    add("/cam/rgb/camera_info", camera_info_message(camera, i));
  }
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error();
  ASSERT_EQ(opened->recording->frames().size(), 3U);
  const auto frame = opened->recording->load(opened->recording->frames()[1]);
  ASSERT_TRUE(frame) << frame.error();
  EXPECT_EQ(cv::norm(frame->color.bgr(), color, cv::NORM_INF), 0);
  EXPECT_FLOAT_EQ(frame->depth.at(3, 4), 1.234F);
  EXPECT_EQ(opened->recording->fps(), 30);
}

TEST_F(ForeignBag, DepthInMetresBecomesMillimetresInAFolder) {
  const cv::Mat1f metres(24, 32, 1.5F);
  for (std::int64_t i = 1; i <= 2; ++i) {
    add("/c/color", color_message({color, image::ChannelOrder::kBgr, nullptr}, i * 50'000'001));
    add("/c/depth", depth_message({metres, 1, nullptr}, i * 50'000'001));
    add("/c/camera_info", camera_info_message(camera, i));
  }
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error();
  ASSERT_TRUE(write_tum_folder(*opened->recording, folder / "tum"));
  const auto tum = image::TumDataset::open(folder / "tum");
  ASSERT_TRUE(tum) << tum.error();
  EXPECT_EQ(tum->frames()[1].stamp_ns, 100'000'002) << "to the nanosecond";
  EXPECT_FLOAT_EQ(tum->load(tum->frames()[1])->depth.at(1, 1), 1.5F);
}

TEST_F(ForeignBag, WhatIsMissingIsNamed) {
  add("/c/color", color_message({color, image::ChannelOrder::kBgr, nullptr}, 1));
  EXPECT_THAT(open().error(), AllOf(HasSubstr("a.mcap"), HasSubstr("no depth pictures")));
}

TEST_F(ForeignBag, ACameraWithoutDescriptionIsRefused) {
  add("/c/color", color_message({color, image::ChannelOrder::kBgr, nullptr}, 1));
  add("/c/depth", depth_message({depth, 0.001F, nullptr}, 1));
  EXPECT_THAT(open().error(), HasSubstr("/c/camera_info"));
}

TEST_F(ForeignBag, PicturesOfAnotherSizeAreErrorsOfTheirFrames) {
  const image::DepthImage odd{cv::Mat1w(12, 16, std::uint16_t{1}), 0.001F, nullptr};
  for (std::int64_t i = 1; i <= 2; ++i) {
    add("/c/color", color_message({color, image::ChannelOrder::kBgr, nullptr}, i * 100'000'000));
    add("/c/depth", depth_message(i == 1 ? image::DepthImage{depth, 0.001F, nullptr} : odd, i * 100'000'000));
  }
  add("/c/camera_info", camera_info_message(camera, 1));
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error();
  EXPECT_TRUE(opened->recording->load(opened->recording->frames()[0]));
  EXPECT_THAT(opened->recording->load(opened->recording->frames()[1]).error(),
              HasSubstr("/c/depth at 0.200000: 16×12 px"));
}

TEST(RecordingFiles, WhatIsNoRecordingIsRefused) {
  const test::TemporaryFolder folder;
  for (const char* name : {"text.mcap", "text.db3", "text.bag"}) {
    test::write_text(folder / name,
                     "this is text, and long enough to have a header of sixteen bytes and more\n");
    EXPECT_THAT(open_recording(folder / name).error(), HasSubstr(name));
  }
  EXPECT_THAT(open_recording(folder / "none.mcap").error(), HasSubstr("none.mcap"));
  EXPECT_THAT(open_recording(folder / "none.db3").error(), HasSubstr("none.db3"));
  EXPECT_THAT(open_recording(folder / "none").error(), HasSubstr("no such folder"));
  EXPECT_THAT(make_bag_writer(folder / "a.bag", mcap::Compression::kLz4).error(), HasSubstr(".mcap"));
}

}  // namespace
}  // namespace rds::recording
