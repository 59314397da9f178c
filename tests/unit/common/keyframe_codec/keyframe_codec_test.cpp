// SPDX-License-Identifier: Apache-2.0
#include "common/keyframe_codec/keyframe_codec.hpp"

#include <functional>

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

#include "common/messages/registry.hpp"
#include "tests/unit/common/keyframe_codec/example_pictures.hpp"

namespace rds::keyframe_codec {
namespace {

using rds_msgs::msg::KeyFrameCompressed;
using rds_msgs::msg::KeyFrameImages;
using testing::HasSubstr;
using testing::StartsWith;

cv::Mat3b pixels_of(const sensor_msgs::msg::Image& color) {
  return {static_cast<int>(color.height()), static_cast<int>(color.width()),
          reinterpret_cast<cv::Vec3b*>(const_cast<std::uint8_t*>(color.data().data()))};
}

class KeyframeCodec : public testing::Test {
 protected:
  KeyFrameCompressed compressed(const KeyFrameImages& keyframe) {
    auto result = compressor_.compress(keyframe);
    EXPECT_TRUE(result.has_value()) << result.error();
    return std::move(*result);
  }
  KeyFrameImages through(const KeyFrameImages& keyframe) {
    auto result = decompressor_.decompress(compressed(keyframe));
    EXPECT_TRUE(result.has_value()) << result.error();
    return std::move(*result);
  }
  std::string why_not_compressed(const std::function<void(KeyFrameImages&)>& spoil) {
    auto keyframe = test::example_keyframe();
    spoil(keyframe);
    const auto result = compressor_.compress(keyframe);
    return result ? "accepted" : result.error();
  }
  std::string why_not_decompressed(const std::function<void(KeyFrameCompressed&)>& spoil) {
    auto keyframe = compressed(test::example_keyframe());
    spoil(keyframe);
    const auto result = decompressor_.decompress(keyframe);
    return result ? "accepted" : result.error();
  }

  KeyframeCompressor compressor_;
  KeyframeDecompressor decompressor_;
};

TEST_F(KeyframeCodec, KeepsAllButNoiseOfTheColours) {
  const auto keyframe = test::example_keyframe();
  auto again = through(keyframe);
  EXPECT_GT(cv::PSNR(pixels_of(again.color()), pixels_of(keyframe.color())), 30);
  EXPECT_EQ(again.color().data().size(), keyframe.color().data().size());
  again.color().data() = keyframe.color().data();
  EXPECT_EQ(again, keyframe);
}

TEST_F(KeyframeCodec, SaysWhatTheDataAre) {
  const auto small = compressed(test::example_keyframe());
  EXPECT_EQ(small.color().format(), "jpeg");
  EXPECT_EQ(small.color().encoding(), "bgr8");
  EXPECT_EQ(small.depth().format(), "ranks_zstd");
  EXPECT_EQ(small.depth().encoding(), "16UC1");
  EXPECT_EQ(small.depth().width(), 64U);
  EXPECT_EQ(small.depth().height(), 48U);
  EXPECT_EQ(small.movable().format(), "planes_zstd");
  EXPECT_EQ(small.movable().width(), 32U);
  EXPECT_EQ(small.movable().encoding(), "mono8");
}

TEST_F(KeyframeCodec, TakesPicturesOfOddSizes) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 5), cv::Size(17, 2)}) {
    const auto keyframe = test::example_keyframe(size);
    const auto again = through(keyframe);
    EXPECT_EQ(again.depth(), keyframe.depth());
    EXPECT_EQ(again.movable(), keyframe.movable());
    EXPECT_EQ(again.color().data().size(), keyframe.color().data().size());
  }
}

TEST_F(KeyframeCodec, TakesRowsWithPadding) {
  const auto keyframe = test::example_keyframe({5, 4});
  auto padded = keyframe;
  const auto pad = [](sensor_msgs::msg::Image& picture, std::uint32_t bytes) {
    std::vector<std::uint8_t> rows;
    for (std::uint32_t y = 0; y < picture.height(); ++y) {
      const auto begin = picture.data().begin() + y * picture.step();
      rows.insert(rows.end(), begin, begin + picture.step());
      rows.insert(rows.end(), bytes, 0xAA);
    }
    picture.step(picture.step() + bytes);
    picture.data(std::move(rows));
  };
  pad(padded.color(), 1);
  pad(padded.depth(), 6);
  pad(padded.movable(), 3);
  EXPECT_EQ(compressed(padded), compressed(keyframe));
}

TEST_F(KeyframeCodec, TakesTheEncodingsThatServicesTake) {
  auto keyframe = test::example_keyframe();
  keyframe.color().encoding("rgb8");
  keyframe.depth().encoding("mono16");
  auto again = through(keyframe);
  EXPECT_EQ(again.color().encoding(), "rgb8");
  EXPECT_EQ(again.depth(), keyframe.depth());

  cv::Mat1f metres(48, 64, 1.25F);
  metres(0, 0) = std::numeric_limits<float>::quiet_NaN();
  keyframe.depth(messages::to_image_message(image::DepthImage{metres, 1.F, nullptr}, keyframe.header()));
  EXPECT_EQ(through(keyframe).depth(), keyframe.depth());

  keyframe.movable(messages::to_image_message(cv::Mat1b(), keyframe.header()));
  EXPECT_EQ(through(keyframe).movable(), keyframe.movable());
}

TEST_F(KeyframeCodec, GivesTheSameBytesWhateverCameBefore) {
  const auto keyframe = test::example_keyframe();
  const auto first = compressed(keyframe);
  compressed(test::example_keyframe({200, 100}));
  EXPECT_EQ(compressed(keyframe), first);
  EXPECT_EQ(KeyframeCompressor().compress(keyframe).value(), first);
}

TEST_F(KeyframeCodec, HasAMessageThatTheBusKnows) {
  const auto small = compressed(test::example_keyframe());
  const auto* type = messages::find_message_type("rds_msgs::msg::dds_::KeyFrameCompressed_");
  ASSERT_NE(type, nullptr);
  std::vector<std::uint8_t> bytes(type->ops->encoded_size(&small));
  ASSERT_EQ(type->ops->encode(&small, bytes.data(), bytes.size()), bytes.size());
  KeyFrameCompressed decoded;
  ASSERT_TRUE(type->ops->decode(bytes.data(), bytes.size(), &decoded));
  EXPECT_EQ(decoded, small);
}

TEST_F(KeyframeCodec, DoesNotCompressWhatServicesWouldRefuse) {
  EXPECT_THAT(why_not_compressed([](auto& k) { k.color().encoding("rgba8"); }),
              StartsWith("color: image encoding"));
  EXPECT_THAT(why_not_compressed([](auto& k) { k.color().data().pop_back(); }),
              StartsWith("color: image data"));
  EXPECT_THAT(why_not_compressed([](auto& k) { k.color().step(1); }), StartsWith("color: image row"));
  EXPECT_THAT(why_not_compressed([](auto& k) { k.depth().encoding("64FC1"); }),
              StartsWith("depth: depth encoding"));
  EXPECT_THAT(why_not_compressed([](auto& k) { k.depth().is_bigendian(1); }), HasSubstr("big-endian"));
  EXPECT_THAT(why_not_compressed([](auto& k) { k.depth().height(0); }),
              StartsWith("depth: width and height"));
  EXPECT_THAT(why_not_compressed([](auto& k) { k.movable().encoding("8UC1"); }),
              StartsWith("movable: mask encoding"));
  EXPECT_THAT(why_not_compressed([](auto& k) { k.movable().width(7); }), StartsWith("movable: mask of"));
  EXPECT_THAT(why_not_compressed([](auto& k) {
                k.color().width(4097);
                k.color().height(4096);
              }),
              StartsWith("color: width and height must be"));
}

TEST_F(KeyframeCodec, RefusesSizesThatNoCameraHas) {
  constexpr auto kTooLarge = "width and height must be 1 or more, and 16777216 px together at most";
  for (const auto& [width, height] :
       {std::pair{0U, 48U}, {64U, 0U}, {4097U, 4096U}, {65536U, 65536U}, {~0U, ~0U}}) {
    const auto resize = [width = width, height = height](auto& picture) {
      picture.width(width);
      picture.height(height);
    };
    EXPECT_EQ(why_not_decompressed([&](auto& k) { resize(k.color()); }), std::string("color: ") + kTooLarge);
    EXPECT_EQ(why_not_decompressed([&](auto& k) { resize(k.depth()); }), std::string("depth: ") + kTooLarge);
    EXPECT_EQ(why_not_decompressed([&](auto& k) { resize(k.movable()); }),
              std::string("movable: ") + kTooLarge);
  }
}

TEST_F(KeyframeCodec, RefusesFormatsAndEncodingsThatItDoesNotKnow) {
  constexpr auto kFormats = "the format must be ranks_zstd for 16 bits, planes_zstd for others";
  EXPECT_EQ(why_not_decompressed([](auto& k) { k.color().format("png"); }), "color: the format must be jpeg");
  EXPECT_EQ(why_not_decompressed([](auto& k) { k.color().encoding("mono8"); }),
            "color: the encoding must be rgb8 or bgr8");
  EXPECT_EQ(why_not_decompressed([](auto& k) { k.depth().format("jpeg"); }),
            std::string("depth: ") + kFormats);
  EXPECT_EQ(why_not_decompressed([](auto& k) { k.depth().encoding(std::string(70'000, 'x')); }),
            "depth: the encoding must be 16UC1, mono16 or 32FC1");
  EXPECT_EQ(why_not_decompressed([](auto& k) { k.movable().encoding("16UC1"); }),
            "movable: the encoding must be mono8");
  EXPECT_EQ(why_not_decompressed([](auto& k) { k.movable().format(""); }),
            std::string("movable: ") + kFormats);
}

TEST_F(KeyframeCodec, RefusesDataThatDoNotFitTheirDescription) {
  EXPECT_EQ(why_not_decompressed([](auto& k) { k.color().width(32); }),
            "color: the JPEG is of another size than declared");
  EXPECT_EQ(why_not_decompressed([](auto& k) {
              k.depth().encoding("32FC1");
              k.depth().format("planes_zstd");
            }),
            "depth: the zstd frame is of another size than declared");
  EXPECT_EQ(why_not_decompressed([](auto& k) { k.movable().height(23); }),
            "movable: the zstd frame is of another size than declared");
  EXPECT_EQ(why_not_decompressed([](auto& k) { k.color().data().clear(); }),
            "color: the data is not a sequential JPEG of three components");
  EXPECT_EQ(why_not_decompressed([](auto& k) { k.depth().data().pop_back(); }),
            "depth: the data is not one whole zstd frame");
}

}  // namespace
}  // namespace rds::keyframe_codec
