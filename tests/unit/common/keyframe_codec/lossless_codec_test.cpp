// SPDX-License-Identifier: Apache-2.0
#include "common/keyframe_codec/lossless_codec.hpp"

#include <cstring>

#include <gmock/gmock.h>
#include <zstd.h>

#include "tests/unit/common/keyframe_codec/example_pictures.hpp"

namespace rds::keyframe_codec {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr const char* kNoFrame = "the data is not one whole zstd frame";
constexpr const char* kOtherSize = "the zstd frame is of another size than declared";
constexpr const char* kDamaged = "the zstd frame is damaged";

Bytes rows_of(const cv::Mat& pixels) {
  const cv::Mat whole = pixels.clone();
  return {whole.data, whole.data + whole.total() * whole.elemSize()};
}

Bytes zstd(const Bytes& content) {
  Bytes frame(ZSTD_compressBound(content.size()));
  frame.resize(ZSTD_compress(frame.data(), frame.size(), content.data(), content.size(), 1));
  return frame;
}

class LosslessCodec : public testing::Test {
 protected:
  void expect_same_after(const cv::Mat& pixels) {
    const auto rows = decompressor_.decompress(compressor_.compress(pixels), pixels.size(), pixels.type());
    ASSERT_TRUE(rows.has_value()) << rows.error();
    EXPECT_EQ(*rows, rows_of(pixels)) << pixels.size();
  }
  void expect_refused(const Bytes& data, cv::Size size, const char* sentence) {
    const auto rows = decompressor_.decompress(data, size, CV_16UC1);
    ASSERT_FALSE(rows.has_value());
    EXPECT_EQ(rows.error(), sentence);
  }

  LosslessCompressor compressor_;
  LosslessDecompressor decompressor_;
};

TEST_F(LosslessCodec, KeepsEveryPixel) {
  for (const cv::Size size :
       {cv::Size(640, 480), cv::Size(1, 1), cv::Size(3, 5), cv::Size(31, 1), cv::Size(1, 31)}) {
    const cv::Mat1w depth = test::example_depth(size);
    expect_same_after(depth);
    expect_same_after(test::with_padding(depth, 5));
    cv::Mat1f metres;
    depth.convertTo(metres, CV_32F, 0.001);
    metres(0, 0) = std::numeric_limits<float>::quiet_NaN();
    expect_same_after(metres);
    expect_same_after(cv::Mat(depth > 1500));
  }
  expect_same_after(cv::Mat1w(480, 640, std::uint16_t{0}));
  expect_same_after(cv::Mat1w(480, 640, std::uint16_t{65535}));
}

TEST_F(LosslessCodec, GivesTheSameBytesWhateverCameBefore) {
  const cv::Mat1w depth = test::example_depth({64, 48});
  const Bytes first = compressor_.compress(depth);
  compressor_.compress(test::example_depth({200, 100}));
  EXPECT_EQ(compressor_.compress(depth), first);
  EXPECT_EQ(LosslessCompressor().compress(test::with_padding(depth, 7)), first);
}

TEST_F(LosslessCodec, RefusesWhatIsTorn) {
  const cv::Size size(16, 12);
  const Bytes data = compressor_.compress(test::example_depth(size));
  for (std::size_t length = 0; length < data.size(); ++length)
    expect_refused({data.begin(), data.begin() + static_cast<std::ptrdiff_t>(length)}, size, kNoFrame);
}

TEST_F(LosslessCodec, RefusesEveryFlippedBitThatMatters) {
  const cv::Mat1w depth = test::example_depth({16, 12});
  const Bytes data = compressor_.compress(depth);
  for (std::size_t bit = 0; bit < 8 * data.size(); ++bit) {
    Bytes spoiled = data;
    spoiled[bit / 8] = static_cast<std::uint8_t>(spoiled[bit / 8] ^ 1U << bit % 8);
    const auto rows = decompressor_.decompress(spoiled, depth.size(), CV_16UC1);
    EXPECT_TRUE(!rows || *rows == rows_of(depth)) << "bit " << bit;
  }
  expect_same_after(depth);
}

TEST_F(LosslessCodec, RefusesAnotherSizeThanDeclared) {
  const cv::Mat1b mask(12, 16, std::uint8_t{1});
  const Bytes data = compressor_.compress(mask);
  for (const cv::Size size : {cv::Size(16, 11), cv::Size(17, 12), cv::Size(1, 1)}) {
    const auto rows = decompressor_.decompress(data, size, CV_8UC1);
    ASSERT_FALSE(rows.has_value());
    EXPECT_EQ(rows.error(), kOtherSize);
  }
  expect_refused(data, mask.size(), kOtherSize);
  expect_refused(zstd({}), {16, 12}, kOtherSize);
}

TEST_F(LosslessCodec, RefusesABombBeforeItGoesOff) {
  const Bytes bomb = zstd(Bytes(8 << 20));
  EXPECT_LT(bomb.size(), 2'000U);
  expect_refused(bomb, {16, 12}, kOtherSize);
}

TEST_F(LosslessCodec, RefusesAFrameThatHoldsMoreThanItSays) {
  Bytes liar = zstd(Bytes(1 << 20));
  // RFC 8878: magic number, descriptor that tells of a size of four bytes, window, that size.
  ASSERT_EQ(liar[4], 0x80);
  const std::uint32_t size = 16 * 12 * 2 + 2;
  std::memcpy(&liar[6], &size, sizeof(size));
  expect_refused(liar, {16, 12}, kDamaged);
}

TEST_F(LosslessCodec, RefusesWhatHasNoValues) {
  const cv::Size size(16, 12);
  const std::size_t planes = 16 * 12 * 2;
  const auto with_values = [&](std::size_t bytes, std::uint8_t content) {
    return zstd(Bytes(planes + bytes, content));
  };
  EXPECT_TRUE(decompressor_.decompress(with_values(2, 0), size, CV_16UC1).has_value());
  EXPECT_TRUE(decompressor_.decompress(with_values(2 * 65536, 0), size, CV_16UC1).has_value());
  expect_refused(with_values(2, 2), size, "a pixel has no value");
  expect_refused(with_values(0, 0), size, kOtherSize);
  expect_refused(with_values(3, 0), size, kOtherSize);
  expect_refused(with_values(2 * 65537, 0), size, kOtherSize);
}

TEST_F(LosslessCodec, RefusesMoreThanOneFrameAndFramesOfOtherKinds) {
  const cv::Size size(16, 12);
  const Bytes data = compressor_.compress(test::example_depth(size));
  Bytes two = data;
  two.insert(two.end(), data.begin(), data.end());
  expect_refused(two, size, kNoFrame);
  Bytes skippable{0x50, 0x2A, 0x4D, 0x18, 1, 0, 0, 0, 0};
  skippable.insert(skippable.end(), data.begin(), data.end());
  expect_refused(skippable, size, kNoFrame);
  expect_refused({0x27, 0xB5, 0x2F, 0xFD, 0, 0, 0, 0, 0}, size, kNoFrame);  // a format of before 1.0
  expect_refused(Bytes(100, 0), size, kNoFrame);
}

}  // namespace
}  // namespace rds::keyframe_codec
