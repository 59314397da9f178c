// SPDX-License-Identifier: Apache-2.0
// Spoiled keyframes from other machines: nothing is decoded beyond the declared size, and what is accepted is
// whole.
#include "common/keyframe_codec/keyframe_codec.hpp"

#include <algorithm>

#include <gmock/gmock.h>

#include "common/bus/type_ops.hpp"
#include "common/messages/camera_conversions.hpp"
#include "tests/fuzz/feed.hpp"
#include "tests/unit/common/image/rvl_encoder.hpp"
#include "tests/unit/common/keyframe_codec/example_pictures.hpp"

namespace rds::fuzz {
namespace {

using keyframe_codec::test::example_color;
using keyframe_codec::test::example_depth;
using keyframe_codec::test::example_keyframe;
using rds_msgs::msg::KeyFrameCompressed;

const cv::Size kSize(24, 16);
constexpr std::size_t kMemoryOfSmallThings = 64 * 1024;  // messages, sentences, pictures of kSize

std::size_t bound(std::size_t bytes) {
  return kMemoryOfSmallThings + 8 * bytes;
}

const bus::TypeOps& type() {
  return bus::type_ops<KeyFrameCompressed>();
}

Bytes encoded(const rds_msgs::msg::KeyFrameImages& keyframe) {
  const auto message = keyframe_codec::KeyframeCompressor().compress(keyframe).value();
  Bytes bytes(type().encoded_size(&message));
  bytes.resize(type().encode(&message, bytes.data(), bytes.size()));
  return bytes;
}

TEST(KeyframeCodec, KeyframesFromTheWire) {
  auto in_metres = example_keyframe(kSize);
  const cv::Mat1f metres(kSize, 1.5F);
  in_metres.depth(messages::to_image_message(image::DepthImage{metres, 1.F, nullptr}, in_metres.header()));
  auto without_mask = example_keyframe({3, 5});
  without_mask.movable({});
  keyframe_codec::KeyframeDecompressor decompressor;
  feed(16, {encoded(example_keyframe(kSize)), encoded(in_metres), encoded(without_mask)}, bound,
       [&](const Bytes& bytes) {
         KeyFrameCompressed message;
         if (!type().decode(bytes.data(), bytes.size(), &message)) return false;
         const auto keyframe = decompressor.decompress(message);
         if (!keyframe) return false;
         const auto& color = keyframe->color();
         EXPECT_EQ(color.data().size(), std::size_t{3} * color.width() * color.height());
         EXPECT_EQ(keyframe->depth().data().size(),
                   std::size_t{keyframe->depth().step()} * keyframe->depth().height());
         return true;
       });
}

TEST(KeyframeCodec, JpegOfAnyone) {
  keyframe_codec::JpegCompressor fine(95);
  keyframe_codec::JpegCompressor coarse(20);
  const image::ColorImage picture{example_color(kSize), image::ChannelOrder::kBgr, nullptr};
  feed(12, {fine.compress(picture), coarse.compress(picture)}, bound, [](const Bytes& bytes) {
    return keyframe_codec::decompress_jpeg(bytes, kSize, image::ChannelOrder::kRgb).has_value();
  });
}

TEST(KeyframeCodec, DepthOfAnyone) {
  const cv::Mat1w depth = example_depth(kSize);
  keyframe_codec::LosslessCompressor compressor;
  keyframe_codec::LosslessDecompressor decompressor;
  const Bytes data = compressor.compress(depth);
  const Bytes empty = compressor.compress(cv::Mat1w(kSize, std::uint16_t{0}));
  const std::vector<Bytes> good{decompressor.decompress(data, kSize, CV_16UC1).value(),
                                decompressor.decompress(empty, kSize, CV_16UC1).value()};
  feed(20, {data, empty}, bound, [&](const Bytes& bytes) {
    const auto rows = decompressor.decompress(bytes, kSize, CV_16UC1);
    EXPECT_TRUE(!rows || std::ranges::find(good, *rows) != good.end())
        << "the checksum let another picture pass";
    return rows.has_value();
  });
}

TEST(CameraMessages, DepthOfAnyDriver) {
  const auto seed = [](const cv::Mat1w& depth) { return image::test::compressed_depth_of(depth); };
  const cv::Mat1w dark(kSize, std::uint16_t{0});
  feed(12, {seed(example_depth(kSize)), seed(dark), seed(cv::Mat1w(kSize, std::uint16_t{900}))}, bound,
       [](const Bytes& bytes) {
         sensor_msgs::msg::CompressedImage message;
         message.format("16UC1; compressedDepth rvl");
         message.data(bytes);
         return messages::camera_depth(message).has_value();
       });
}

}  // namespace
}  // namespace rds::fuzz
