// SPDX-License-Identifier: Apache-2.0
#include "common/messages/conversions.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "common/messages/detection_conversions.hpp"
#include "common/messages/image_conversions.hpp"

namespace rds::messages {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Time, NanosecondsSurviveTheMessage) {
  for (const std::int64_t ns : {0L, 1L, 999'999'999L, 1'305'031'102'175'304'000L, -1L, -2'000'000'001L}) {
    EXPECT_EQ(to_nanoseconds(to_time(ns)), ns);
  }
}

TEST(Time, SaturatesBeyondTheRangeOfTheMessage) {
  EXPECT_EQ(to_time(std::numeric_limits<std::int64_t>::max()).sec(),
            std::numeric_limits<std::int32_t>::max());
}

TEST(PoseMessage, SurvivesBothForms) {
  const geometry::Pose pose = geometry::make_pose(
      {1, -2, 3}, Eigen::Quaterniond(Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, 2, 3).normalized())));
  EXPECT_TRUE(to_pose(to_pose_message(pose))->isApprox(pose, 1e-12));
  EXPECT_TRUE(to_pose(to_transform_message(pose))->isApprox(pose, 1e-12));
}

TEST(PoseMessage, RefusesWhatIsNoPose) {
  geometry_msgs::msg::Pose message;
  EXPECT_FALSE(to_pose(message).has_value());  // all zero: no quaternion
  message.orientation().w(1);
  EXPECT_TRUE(to_pose(message).has_value());
  message.position().y(kNan);
  EXPECT_FALSE(to_pose(message).has_value());
}

geometry::CameraModel camera() {
  return {.width = 640,
          .height = 480,
          .fx = 525,
          .fy = 526,
          .cx = 319.5,
          .cy = 239.5,
          .distortion = {.1, -.2, .01, .02, .3}};
}

TEST(CameraInfo, CameraSurvivesTheMessage) {
  EXPECT_EQ(*to_camera_model(to_camera_info(camera(), make_header(5, "camera"))), camera());
}

TEST(CameraInfo, TellsTheLens) {
  auto message = to_camera_info(camera(), {});
  message.distortion_model("rational_polynomial");
  message.d().resize(8, 0.0);
  EXPECT_EQ(to_camera_model(message), camera()) << "without k4 to k6 it is a plumb bob";
  message.d()[6] = 0.1;
  EXPECT_EQ(to_lens(message)->model, geometry::LensModel::kRationalPolynomial);
  EXPECT_EQ(to_lens(message)->coefficients[6], 0.1);
  EXPECT_FALSE(to_camera_model(message)->has_distortion()) << "its pictures are resampled";
  message.distortion_model("equidistant");
  message.d().assign(4, 0.1);
  EXPECT_EQ(to_lens(message)->model, geometry::LensModel::kEquidistant);
  message.d().clear();
  message.distortion_model("");
  EXPECT_TRUE(to_lens(message)->is_plain()) << "no distortion at all";
}

TEST(CameraInfo, RefusesUnknownDistortionAndNonsense) {
  auto message = to_camera_info(camera(), {});
  message.distortion_model("equidistant");
  EXPECT_FALSE(to_camera_model(message).has_value()) << "five coefficients, it has four";
  message.distortion_model("omnidirectional");
  EXPECT_FALSE(to_camera_model(message).has_value());
  message = to_camera_info(camera(), {});
  message.k()[0] = kNan;
  EXPECT_FALSE(to_camera_model(message).has_value());
  message = to_camera_info(camera(), {});
  message.width(4'000'000'000U);
  EXPECT_FALSE(to_camera_model(message).has_value());
}

using sensor_msgs::msg::Image;

std::shared_ptr<Image> image_message(const std::string& encoding, std::uint32_t step, std::size_t bytes) {
  auto message = std::make_shared<Image>();
  message->width(4);
  message->height(3);
  message->encoding(encoding);
  message->step(step);
  message->data().resize(bytes);
  return message;
}

TEST(ColorImage, SharesTheMessagesMemory) {
  const auto message = image_message("rgb8", 12, 36);
  std::weak_ptr<Image> alive = message;
  auto image = to_color_image(message);
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(image->pixels.data, message->data().data());
  EXPECT_EQ(image->order, image::ChannelOrder::kRgb);
  EXPECT_EQ(image->pixels.size(), cv::Size(4, 3));
  EXPECT_EQ(image->owner.get(), message.get());
}

TEST(ColorImage, ReadsRowsWithPadding) {
  auto message = image_message("bgr8", 16, 2 * 16 + 12);
  message->data()[16] = 77;
  const auto image = to_color_image(message);
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(image->pixels.at<cv::Vec3b>(1, 0)[0], 77);
  const Image again = to_image_message(*image, {});
  EXPECT_EQ(again.step(), 12U);
  EXPECT_EQ(again.data()[12], 77);
}

TEST(ColorImage, SaysWhatIsWrong) {
  EXPECT_EQ(to_color_image(image_message("mono8", 12, 36)).error(),
            "image encoding 'mono8', expected rgb8 or bgr8");
  EXPECT_EQ(to_color_image(image_message("rgb8", 11, 36)).error(),
            "image row of 11 bytes, expected at least 12");
  EXPECT_EQ(to_color_image(image_message("rgb8", 12, 35)).error(),
            "image data of 35 bytes, expected at least 36");
  auto huge = image_message("rgb8", 12, 36);
  huge->height(4'000'000'000U);
  EXPECT_FALSE(to_color_image(huge).has_value());
  huge->height(0);
  EXPECT_FALSE(to_color_image(huge).has_value());
}

TEST(DepthImage, ReadsMillimetresAndMetres) {
  auto millimetres = image_message("16UC1", 8, 24);
  millimetres->data()[0] = 0xE8;
  millimetres->data()[1] = 0x03;
  EXPECT_FLOAT_EQ(to_depth_image(millimetres)->at(0, 0), 1.0F);
  auto metres = image_message("32FC1", 16, 48);
  const float value = 2.5F;
  std::memcpy(metres->data().data(), &value, sizeof value);
  EXPECT_FLOAT_EQ(to_depth_image(metres)->at(0, 0), 2.5F);
  metres->is_bigendian(1);
  EXPECT_FALSE(to_depth_image(metres).has_value());
  EXPECT_FALSE(to_depth_image(image_message("rgb8", 12, 36)).has_value());
}

TEST(DepthImage, IsWrittenInRosUnits) {
  const cv::Mat raw(2, 2, CV_16UC1, cv::Scalar(5000));
  const Image message = to_image_message(image::DepthImage{raw, 1.0F / 5000, nullptr}, {});  // TUM's unit
  EXPECT_EQ(message.encoding(), "16UC1");
  EXPECT_FLOAT_EQ(to_depth_image(std::make_shared<Image>(message))->at(1, 1), 1.0F);
  EXPECT_THROW(to_image_message(image::DepthImage{cv::Mat(2, 2, CV_8UC1), 1, nullptr}, {}),
               std::invalid_argument);
}

TEST(CellMask, SurvivesTheMessage) {
  cv::Mat1b mask(3, 4, std::uint8_t{0});
  mask(2, 1) = 255;
  const auto read = to_cell_mask(to_image_message(mask, {}), {16, 11});
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(cv::countNonZero(*read != mask), 0);
  EXPECT_TRUE(to_cell_mask(to_image_message(cv::Mat1b(), {}), {16, 11})->empty());
  EXPECT_TRUE(to_cell_mask(Image(), {16, 11})->empty());
}

TEST(CellMask, SaysWhatIsWrong) {
  const Image good = to_image_message(cv::Mat1b(3, 4, std::uint8_t{0}), {});
  EXPECT_EQ(to_cell_mask(good, {16, 20}).error(),
            "mask of 4 x 3 cells, expected square cells that cover the picture");
  EXPECT_FALSE(to_cell_mask(good, {2, 2}).has_value());
  Image bad = good;
  bad.encoding("16UC1");
  EXPECT_EQ(to_cell_mask(bad, {16, 12}).error(), "mask encoding '16UC1', expected mono8");
  bad = good;
  bad.data().resize(11);
  EXPECT_FALSE(to_cell_mask(bad, {16, 12}).has_value());
  bad = good;
  bad.width(0);
  EXPECT_FALSE(to_cell_mask(bad, {16, 12}).has_value());
  bad.width(4'000'000'000U);
  EXPECT_FALSE(to_cell_mask(bad, {16, 12}).has_value());
}

TEST(Detections, ImageBoxesSurviveTheMessage) {
  const std::vector<ImageDetection> detections = {{"person", .75F, {10, 20, 50, 120}, 2.5F},
                                                  {"chair", .5F, {0, 0, 1, 1}, 0}};
  const auto read = to_detections(to_detection_message(detections, make_header(7, "camera")));
  ASSERT_TRUE(read.has_value());
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ((*read)[0].label, "person");
  EXPECT_FLOAT_EQ((*read)[0].score, .75F);
  EXPECT_EQ((*read)[0].box, detections[0].box);
  EXPECT_FLOAT_EQ((*read)[0].depth_m, 2.5F);
}

geometry::Pose turned_pose() {
  return geometry::make_pose({1, 2, 3}, Eigen::Quaterniond(0.5, 0.1, -0.4, 0.7));
}

TEST(Detections, SpatialBoxesSurviveTheMessage) {
  const geometry::OrientedBox box{turned_pose(), {0.5, 1.8, 0.6}};
  const std::vector<SpatialDetection> detections = {{"person", .75F, box, "7"}};
  const auto read = to_detections(to_detection_message(detections, make_header(7, "map")));
  ASSERT_TRUE(read.has_value());
  ASSERT_EQ(read->size(), 1U);
  EXPECT_EQ((*read)[0].id, "7");
  EXPECT_TRUE((*read)[0].box.map_from_box.isApprox(box.map_from_box));
  EXPECT_TRUE((*read)[0].box.size.isApprox(box.size));
}

TEST(Detections, OtherLabelsOfABoxAreFurtherHypotheses) {
  const geometry::OrientedBox box{turned_pose(), {0.5, 1.8, 0.6}};
  const std::vector<SpatialDetection> detections = {
      {"sofa", .6F, box, "7", {{"chair", .3F}, {"bench", .1F}}}};
  const auto message = to_detection_message(detections, {});
  const auto& results = message.detections().at(0).results();
  ASSERT_EQ(results.size(), 3U);
  EXPECT_EQ(results[1].hypothesis().class_id(), "chair");
  EXPECT_FLOAT_EQ(static_cast<float>(results[2].hypothesis().score()), .1F);
  EXPECT_EQ(results[2].pose().pose(), message.detections()[0].bbox().center());
  EXPECT_EQ(to_detections(message)->at(0).label, "sofa");
}

TEST(Detections, TakeTheBestHypothesisAndSkipTheUnlabelled) {
  auto message = to_detection_message(std::vector<ImageDetection>{{"cat", .3F, {0, 0, 4, 4}, 0}}, {});
  auto& results = message.detections()[0].results();
  results.push_back(results[0]);
  results[1].hypothesis().class_id("dog");
  results[1].hypothesis().score(.9);
  EXPECT_EQ(to_detections(message)->at(0).label, "dog");
  results.clear();
  EXPECT_TRUE(to_detections(message)->empty());
}

TEST(Detections, RefuseNanAndNegativeSizes) {
  auto flat = to_detection_message(std::vector<ImageDetection>{{"cat", .3F, {0, 0, 4, 4}, 0}}, {});
  flat.detections()[0].bbox().size_x(-1);
  EXPECT_EQ(to_detections(flat).error(), "detection 0: the box has a negative size");
  flat.detections()[0].bbox().size_x(kNan);
  EXPECT_FALSE(to_detections(flat).has_value());
  auto solid =
      to_detection_message(std::vector<SpatialDetection>{{"cat", .3F, {turned_pose(), {1, 1, 1}}, ""}}, {});
  solid.detections()[0].bbox().center().position().x(kNan);
  EXPECT_FALSE(to_detections(solid).has_value());
}

}  // namespace
}  // namespace rds::messages
