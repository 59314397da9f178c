// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/messages/camera_conversions.hpp"
#include "tests/unit/common/image/rvl_encoder.hpp"

/// Whatever a driver sends of one scene gives the picture that rgb8 gives, or as much of it as its encoding
/// carries.
namespace rds::messages {
namespace {

using sensor_msgs::msg::CompressedImage;
using sensor_msgs::msg::Image;

/// A smooth scene in BGR, so that a mosaic of colours can be put together again.
cv::Mat3b scene() {
  cv::Mat3b picture(48, 64);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      picture(y, x) =
          cv::Vec3b(static_cast<std::uint8_t>(40 + 2 * x), static_cast<std::uint8_t>(60 + 2 * y), 150);
  return picture;
}

std::shared_ptr<Image> message_of(const cv::Mat& pixels, const std::string& encoding,
                                  std::uint32_t padding = 0) {
  auto message = std::make_shared<Image>();
  message->width(static_cast<std::uint32_t>(pixels.cols));
  message->height(static_cast<std::uint32_t>(pixels.rows));
  message->encoding(encoding);
  const auto row = static_cast<std::uint32_t>(static_cast<std::size_t>(pixels.cols) * pixels.elemSize());
  message->step(row + padding);
  for (int y = 0; y < pixels.rows; ++y) {
    message->data().insert(message->data().end(), pixels.ptr(y), pixels.ptr(y) + row);
    message->data().resize(message->data().size() + padding, 0xEE);
  }
  return message;
}

/// Of any channel, apart from the border of two pixels.
double largest_difference(const cv::Mat& a, const cv::Mat& b) {
  const cv::Rect inside(2, 2, a.cols - 4, a.rows - 4);
  return cv::norm(a(inside), b(inside), cv::NORM_INF);
}

cv::Mat converted(const cv::Mat& picture, int code) {
  cv::Mat result;
  cv::cvtColor(picture, result, code);
  return result;
}

/// Two pixels share their colour. @param luma_first  YUYV, else UYVY.
cv::Mat yuv422(const cv::Mat3b& picture, bool luma_first) {
  cv::Mat packed(picture.size(), CV_8UC2);
  const auto clamped = [](double v) { return cv::saturate_cast<std::uint8_t>(v); };
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      const cv::Vec3d c = picture(y, x);  // ITU-R BT.601, studio swing
      const std::uint8_t luma = clamped(16 + .257 * c[2] + .504 * c[1] + .098 * c[0]);
      const std::uint8_t u = clamped(128 - .148 * c[2] - .291 * c[1] + .439 * c[0]);
      const std::uint8_t v = clamped(128 + .439 * c[2] - .368 * c[1] - .071 * c[0]);
      const std::uint8_t chroma = x % 2 == 0 ? u : v;
      packed.at<cv::Vec2b>(y, x) = luma_first ? cv::Vec2b(luma, chroma) : cv::Vec2b(chroma, luma);
    }
  return packed;
}

/// @param pattern  channels of BGR in the first two pixels of the first row and of the second.
cv::Mat bayer(const cv::Mat3b& picture, const std::array<int, 4>& pattern) {
  cv::Mat1b mosaic(picture.size());
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      mosaic(y, x) = picture(y, x)[pattern[static_cast<std::size_t>(2 * (y % 2) + x % 2)]];
  return mosaic;
}

struct Encoded {
  std::string encoding;
  cv::Mat pixels;
  double tolerance;  // grey levels
};

std::vector<Encoded> encoded_scenes() {
  const cv::Mat3b bgr = scene();
  return {{"bgr8", bgr, 0},
          {"rgb8", converted(bgr, cv::COLOR_BGR2RGB), 0},
          {"bgra8", converted(bgr, cv::COLOR_BGR2BGRA), 0},
          {"rgba8", converted(bgr, cv::COLOR_BGR2RGBA), 0},
          {"yuv422", yuv422(bgr, false), 5},
          {"uyvy", yuv422(bgr, false), 5},
          {"yuv422_yuy2", yuv422(bgr, true), 5},
          {"yuyv", yuv422(bgr, true), 5},
          {"bayer_rggb8", bayer(bgr, {2, 1, 1, 0}), 2},
          {"bayer_bggr8", bayer(bgr, {0, 1, 1, 2}), 2},
          {"bayer_gbrg8", bayer(bgr, {1, 0, 2, 1}), 2},
          {"bayer_grbg8", bayer(bgr, {1, 2, 0, 1}), 2}};
}

TEST(ColorEncodings, GiveThePictureOfRgb8) {
  for (const auto& [encoding, pixels, tolerance] : encoded_scenes())
    for (const std::uint32_t padding : {0U, 12U}) {
      const auto image = camera_color(message_of(pixels, encoding, padding));
      ASSERT_TRUE(image) << encoding << ": " << image.error();
      EXPECT_LE(largest_difference(image->bgr(), scene()), tolerance) << encoding << " " << padding;
    }
}

TEST(ColorEncodings, OfGreyGiveTheGreyOfThePicture) {
  const cv::Mat gray = converted(scene(), cv::COLOR_BGR2GRAY);
  cv::Mat sixteen;
  gray.convertTo(sixteen, CV_16U, 257);
  const auto eight_bits = camera_color(message_of(gray, "mono8"));
  const auto sixteen_bits = camera_color(message_of(sixteen, "mono16"));
  auto reversed = message_of(sixteen, "mono16");
  for (std::size_t i = 0; i < reversed->data().size(); i += 2)
    std::swap(reversed->data()[i], reversed->data()[i + 1]);
  reversed->is_bigendian(1);
  const auto big_endian = camera_color(reversed);
  for (const auto* image : {&eight_bits, &sixteen_bits, &big_endian}) {
    ASSERT_TRUE(*image);
    cv::Mat again;
    (*image)->to_gray(again);
    EXPECT_EQ(cv::norm(again, gray, cv::NORM_INF), 0);
  }
}

TEST(ColorEncodings, SayWhatIsWrong) {
  EXPECT_EQ(camera_color(message_of(cv::Mat(4, 5, CV_8UC2, cv::Scalar::all(9)), "yuyv")).error(),
            "image of 5 x 4 px, expected even numbers for yuyv");
  EXPECT_EQ(camera_color(message_of(cv::Mat3b(4, 6), "64FC4")).error(),
            "image encoding '64FC4', expected one of rgb8, bgr8, rgba8, bgra8, mono8, mono16, yuv422, uyvy, "
            "yuv422_yuy2, "
            "yuyv, bayer_rggb8, bayer_bggr8, bayer_gbrg8, bayer_grbg8");
  EXPECT_EQ(camera_color(message_of(cv::Mat1b(4, 6), "mono16")).error(),
            "image row of 6 bytes, expected at least 12");
}

TEST(DepthEncodings, MayBeBigEndian) {
  const cv::Mat1w values(3, 4, std::uint16_t{0x1234});
  auto message = message_of(values, "16UC1");
  for (std::size_t i = 0; i < message->data().size(); i += 2)
    std::swap(message->data()[i], message->data()[i + 1]);
  message->is_bigendian(1);
  const auto depth = camera_depth(message);
  ASSERT_TRUE(depth);
  EXPECT_FLOAT_EQ(depth->at(1, 1), 0x1234 * .001F);
}

CompressedImage compressed(const cv::Mat& picture, const char* ending, const std::string& format,
                           const std::vector<std::uint8_t>& head = {}) {
  CompressedImage message;
  std::vector<std::uint8_t> bytes;
  cv::imencode(ending, picture, bytes);
  bytes.insert(bytes.begin(), head.begin(), head.end());
  message.format(format);
  message.data(bytes);
  return message;
}

TEST(CompressedPictures, AreThoseOfRgb8) {
  const auto png = camera_color(compressed(scene(), ".png", "rgb8; png compressed bgr8"));
  ASSERT_TRUE(png);
  EXPECT_EQ(cv::norm(png->bgr(), scene(), cv::NORM_INF), 0);
  const auto jpeg = camera_color(compressed(scene(), ".jpg", "rgb8; jpeg compressed bgr8"));
  ASSERT_TRUE(jpeg);
  EXPECT_LE(largest_difference(jpeg->bgr(), scene()), 8);
  CompressedImage torn = compressed(scene(), ".jpg", "jpeg");
  torn.data().resize(torn.data().size() / 2);
  EXPECT_FALSE(camera_color(torn));
}

TEST(CompressedPictures, ThatClaimToBeHugeAreNotDecoded) {
  CompressedImage huge = compressed(scene(), ".jpg", "jpeg");
  auto& bytes = huge.data();
  const std::array<std::uint8_t, 4> frame{0xFF, 0xC0, 0x00,
                                          0x11};  // the marker and the length of its segment
  const auto found = std::ranges::search(bytes, frame);
  ASSERT_FALSE(found.empty());
  const std::array<std::uint8_t, 4> size{0x3E, 0x80, 0x3E, 0x80};  // 16000 px high and wide
  std::ranges::copy(size, found.begin() + 5);
  EXPECT_FALSE(camera_color(huge));
}

TEST(CompressedDepth, IsInMillimetresOrInverse) {
  const cv::Mat1w millimetres(24, 32, std::uint16_t{1234});
  const std::vector<std::uint8_t> no_parameters(12, 0);
  for (const auto& message : {compressed(millimetres, ".png", "16UC1; compressedDepth png", no_parameters),
                              compressed(millimetres, ".png", "16UC1; png compressed ")}) {
    const auto depth = camera_depth(message);
    ASSERT_TRUE(depth) << depth.error();
    EXPECT_FLOAT_EQ(depth->at(3, 4), 1.234F);
  }
  // As compressed_depth_image_transport quantises metres: A = quantisation · (quantisation + 1), B = 1 − A /
  // largest depth.
  const float a = 100 * 101;
  const float b = 1 - a / 10;
  std::vector<std::uint8_t> head(12, 0);
  std::memcpy(head.data() + 4, &a, 4);
  std::memcpy(head.data() + 8, &b, 4);
  cv::Mat1w inverse(24, 32, static_cast<std::uint16_t>(std::lround(a / 2.5F + b)));
  inverse(0, 0) = 0;
  const auto depth = camera_depth(compressed(inverse, ".png", "32FC1; compressedDepth png", head));
  ASSERT_TRUE(depth) << depth.error();
  EXPECT_NEAR(depth->at(3, 4), 2.5F, 0.001F);
  EXPECT_EQ(depth->at(0, 0), 0) << "no measurement";
}

TEST(CompressedDepth, SaysWhatItCannotRead) {
  EXPECT_FALSE(
      camera_depth(compressed(scene(), ".png", "16UC1; compressedDepth png", std::vector<std::uint8_t>(12))));
  CompressedImage unknown;
  unknown.format("16UC1; compressedDepth zstd");
  unknown.data().assign(100, 7);
  EXPECT_NE(camera_depth(unknown).error().find("compressedDepth zstd"), std::string::npos);
  EXPECT_FALSE(camera_depth(CompressedImage()));
}

CompressedImage rvl(const cv::Mat1w& depth, const std::string& format,
                    const std::vector<std::uint8_t>& head) {
  CompressedImage message;
  message.format(format);
  message.data(image::test::compressed_depth_of(depth, head));
  return message;
}

TEST(CompressedDepth, OfRvlIsThatOfPng) {
  cv::Mat1w depth(24, 32, std::uint16_t{1234});
  depth(3, 4) = 0;
  depth(5, 6) = 60000;
  const std::vector<std::uint8_t> no_parameters(12, 0);
  const auto read = camera_depth(rvl(depth, "16UC1; compressedDepth rvl", no_parameters));
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(cv::norm(read->values, depth, cv::NORM_INF), 0);
  EXPECT_EQ(read->metres_per_unit, .001F);
  const float parameters[] = {100 * 101, 1 - 100 * 101 / 10.F};
  std::vector<std::uint8_t> head(12, 0);
  std::memcpy(head.data() + 4, parameters, 8);
  const auto of_png = camera_depth(compressed(depth, ".png", "32FC1; compressedDepth png", head));
  const auto of_rvl = camera_depth(rvl(depth, "32FC1; compressedDepth rvl", head));
  ASSERT_TRUE(of_rvl) << of_rvl.error();
  EXPECT_EQ(cv::norm(of_rvl->values, of_png->values, cv::NORM_INF), 0);
}

TEST(CompressedDepth, OfRvlThatIsTornOrClaimsToBeHugeIsRefused) {
  const CompressedImage good = rvl(cv::Mat1w(24, 32, std::uint16_t{1234}), "16UC1; compressedDepth rvl",
                                   std::vector<std::uint8_t>(12, 0));
  for (std::size_t length = 0; length + 4 <= good.data().size(); ++length) {
    CompressedImage torn = good;
    torn.data().resize(length);
    EXPECT_FALSE(camera_depth(torn)) << length;
  }
  for (const std::size_t side : {12U, 16U})
    for (const std::uint8_t high : std::array<std::uint8_t, 3>{0x01, 0x7F, 0xFF}) {
      CompressedImage huge = good;
      huge.data()[side + 3] = high;
      const auto read = camera_depth(huge);
      ASSERT_FALSE(read);
      EXPECT_NE(read.error().find("RVL of the size it declares"), std::string::npos);
    }
}

}  // namespace
}  // namespace rds::messages
