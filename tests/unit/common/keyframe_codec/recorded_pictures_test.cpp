// SPDX-License-Identifier: Apache-2.0
// Pictures of real cameras, as the tracker publishes them.
#include <gtest/gtest.h>

#include "common/image/tum_dataset.hpp"
#include "common/keyframe_codec/keyframe_codec.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/unit/common/keyframe_codec/example_pictures.hpp"

namespace rds::keyframe_codec {
namespace {

constexpr std::size_t kEvery = 50;
constexpr std::size_t kMostBytes = 200'000;
constexpr double kLeastPsnr_db = 37;

void expect_small_and_same(const std::string& recording) {
  const auto dataset = image::TumDataset::open(rds::test::shared() / "data" / recording);
  ASSERT_TRUE(dataset.has_value()) << dataset.error();
  KeyframeCompressor compressor;
  KeyframeDecompressor decompressor;
  for (std::size_t i = 0; i < dataset->frames().size(); i += kEvery) {
    const auto frame = dataset->load(dataset->frames()[i]);
    ASSERT_TRUE(frame.has_value()) << frame.error();
    auto keyframe = test::example_keyframe();
    keyframe.color(messages::to_image_message(frame->color, keyframe.header()));
    keyframe.depth(messages::to_image_message(frame->depth, keyframe.header()));
    keyframe.movable({});
    const auto small = compressor.compress(keyframe);
    ASSERT_TRUE(small.has_value()) << small.error();
    EXPECT_LE(small->color().data().size() + small->depth().data().size(), kMostBytes) << "frame " << i;
    const auto again = decompressor.decompress(*small);
    ASSERT_TRUE(again.has_value()) << again.error();
    EXPECT_EQ(again->depth(), keyframe.depth()) << "frame " << i;
    const cv::Mat color(frame->color.pixels.size(), CV_8UC3,
                        const_cast<std::uint8_t*>(again->color().data().data()));
    EXPECT_GE(cv::PSNR(color, frame->color.pixels), kLeastPsnr_db) << "frame " << i;
  }
}

TEST(RecordedPictures, OfAKitchenAreSmallAndTheSame) {
  RDS_REQUIRE_SHARED("data/7scenes_kitchen");
  expect_small_and_same("7scenes_kitchen");
}

TEST(RecordedPictures, OfAnOfficeAreSmallAndTheSame) {
  RDS_REQUIRE_SHARED("data/tum_fr1_rpy");
  expect_small_and_same("tum_fr1_rpy");
}

}  // namespace
}  // namespace rds::keyframe_codec
