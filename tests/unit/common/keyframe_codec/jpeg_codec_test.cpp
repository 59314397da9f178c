// SPDX-License-Identifier: Apache-2.0
#include "common/keyframe_codec/jpeg_codec.hpp"

#include <stdexcept>

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/unit/common/keyframe_codec/example_pictures.hpp"

namespace rds::keyframe_codec {
namespace {

using Bytes = std::vector<std::uint8_t>;
using image::ChannelOrder;

constexpr const char* kNoJpeg = "the data is not a sequential JPEG of three components";
constexpr const char* kOtherSize = "the JPEG is of another size than declared";
constexpr const char* kDamaged = "the JPEG is damaged";

image::ColorImage picture_of(const cv::Mat& pixels, ChannelOrder order = ChannelOrder::kBgr) {
  return {pixels, order, nullptr};
}

Bytes opencv_jpeg(const cv::Mat& pixels, std::vector<int> parameters = {}) {
  Bytes jpeg;
  cv::imencode(".jpg", pixels, jpeg, parameters);
  return jpeg;
}

class JpegCodec : public testing::Test {
 protected:
  cv::Mat3b decoded(const Bytes& data, cv::Size size, ChannelOrder order = ChannelOrder::kBgr) {
    auto rows = decompress_jpeg(data, size, order);
    EXPECT_TRUE(rows.has_value()) << rows.error();
    return cv::Mat(size, CV_8UC3, rows->data()).clone();
  }
  void expect_refused(const Bytes& data, cv::Size size, const char* sentence) {
    const auto rows = decompress_jpeg(data, size, ChannelOrder::kBgr);
    ASSERT_FALSE(rows.has_value());
    EXPECT_EQ(rows.error(), sentence);
  }

  JpegCompressor compressor_{85};
};

TEST_F(JpegCodec, GivesNearlyTheSamePicture) {
  for (const cv::Size size : {cv::Size(640, 480), cv::Size(64, 48), cv::Size(33, 17)}) {
    const cv::Mat3b color = test::example_color(size);
    EXPECT_GT(cv::PSNR(decoded(compressor_.compress(picture_of(color)), size), color), 30) << size;
  }
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 5)}) {
    const cv::Mat3b color(size, cv::Vec3b(40, 90, 200));
    EXPECT_GT(cv::PSNR(decoded(compressor_.compress(picture_of(color)), size), color), 40) << size;
  }
}

TEST_F(JpegCodec, KeepsTheOrderOfChannels) {
  const cv::Mat3b red(16, 16, cv::Vec3b(10, 20, 240));
  cv::Mat3b rgb;
  cv::cvtColor(red, rgb, cv::COLOR_BGR2RGB);
  const Bytes data = compressor_.compress(picture_of(rgb, ChannelOrder::kRgb));
  EXPECT_EQ(data, compressor_.compress(picture_of(red)));
  EXPECT_GT(cv::PSNR(decoded(data, red.size()), red), 40);
  EXPECT_GT(cv::PSNR(decoded(data, red.size(), ChannelOrder::kRgb), rgb), 40);
}

TEST_F(JpegCodec, GivesTheSameBytesWhateverCameBefore) {
  const cv::Mat3b color = test::example_color({64, 48});
  const Bytes first = compressor_.compress(picture_of(color));
  compressor_.compress(picture_of(test::example_color({300, 200})));
  EXPECT_EQ(compressor_.compress(picture_of(color)), first);
  EXPECT_EQ(JpegCompressor(85).compress(picture_of(test::with_padding(color, 7))), first);
}

TEST_F(JpegCodec, RefusesWhatIsTorn) {
  const cv::Size size(24, 16);
  const Bytes data = compressor_.compress(picture_of(test::example_color(size)));
  for (std::size_t length = 0; length + 1 < data.size(); ++length) {
    const Bytes torn(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_FALSE(decompress_jpeg(torn, size, ChannelOrder::kBgr).has_value()) << length << " bytes";
  }
}

TEST_F(JpegCodec, SurvivesEveryFlippedBit) {
  const cv::Size size(24, 16);
  const Bytes data = compressor_.compress(picture_of(test::example_color(size)));
  for (std::size_t bit = 0; bit < 8 * data.size(); ++bit) {
    Bytes spoiled = data;
    spoiled[bit / 8] = static_cast<std::uint8_t>(spoiled[bit / 8] ^ 1U << bit % 8);
    const auto rows = decompress_jpeg(spoiled, size, ChannelOrder::kBgr);
    EXPECT_TRUE(!rows || rows->size() == 3U * 24 * 16) << "bit " << bit;
  }
  decoded(data, size);
}

TEST_F(JpegCodec, RefusesAnotherSizeThanDeclared) {
  const Bytes data = compressor_.compress(picture_of(test::example_color({64, 48})));
  expect_refused(data, {64, 47}, kOtherSize);
  expect_refused(data, {32, 24}, kOtherSize);
  expect_refused(data, {65, 48}, kOtherSize);
}

TEST_F(JpegCodec, RefusesWhatIsNotDecodedRowByRow) {
  const cv::Mat3b color = test::example_color({64, 48});
  expect_refused(opencv_jpeg(color, {cv::IMWRITE_JPEG_PROGRESSIVE, 1}), color.size(), kNoJpeg);
  expect_refused(opencv_jpeg(cv::Mat1b(48, 64, std::uint8_t{9})), color.size(), kNoJpeg);
  expect_refused({}, color.size(), kNoJpeg);
  expect_refused(Bytes(1000, 0xFF), color.size(), kNoJpeg);
  Bytes png;
  cv::imencode(".png", color, png);
  expect_refused(png, color.size(), kNoJpeg);
}

TEST_F(JpegCodec, RefusesAMarkerThatDecodersStepOverInDifferentWays) {
  Bytes data = compressor_.compress(picture_of(test::example_color({64, 48})));
  data.insert(data.begin() + 2, {0xFF, 0x01});
  expect_refused(data, {64, 48}, kNoJpeg);
}

TEST_F(JpegCodec, RefusesARestOfAnotherPicture) {
  Bytes data = compressor_.compress(picture_of(test::example_color({64, 48})));
  data.resize(data.size() - 40);
  const Bytes end{0xFF, 0xD9};
  data.insert(data.end(), end.begin(), end.end());
  expect_refused(data, {64, 48}, kDamaged);
}

TEST_F(JpegCodec, ReadsWhatOtherLibrariesWrite) {
  const cv::Mat3b color = test::example_color({64, 48});
  EXPECT_GT(cv::PSNR(decoded(opencv_jpeg(color), color.size()), color), 30);
  EXPECT_GT(cv::PSNR(decoded(opencv_jpeg(color, {cv::IMWRITE_JPEG_RST_INTERVAL, 2}), color.size()), color),
            30);
}

TEST_F(JpegCodec, RefusesAQualityOutsideItsRange) {
  EXPECT_THROW(JpegCompressor(0), std::invalid_argument);
  EXPECT_THROW(JpegCompressor(101), std::invalid_argument);
}

}  // namespace
}  // namespace rds::keyframe_codec
