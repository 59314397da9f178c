// SPDX-License-Identifier: Apache-2.0
#include "common/image/picture_file.hpp"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/temporary_folder.hpp"

namespace rds::image {
namespace {
using testing::AllOf;
using testing::HasSubstr;

cv::Mat noise(int type) {
  cv::Mat picture(48, 64, type);
  cv::RNG random(1);
  random.fill(picture, cv::RNG::UNIFORM, 1, 200);
  return picture;
}

std::vector<std::uint8_t> encoded(const char* extension, int type, const std::vector<int>& parameters = {}) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, noise(type), bytes, parameters);
  return bytes;
}

std::filesystem::path stored(const test::TemporaryFolder& folder, std::span<const std::uint8_t> bytes) {
  test::write_text(folder / "picture", std::string(bytes.begin(), bytes.end()));
  return folder / "picture";
}

TEST(PictureFile, EveryPrefixOfAPictureIsTruncated) {
  const std::vector<std::vector<std::uint8_t>> pictures{
      encoded(".jpg", CV_8UC3), encoded(".jpg", CV_8UC3, {cv::IMWRITE_JPEG_PROGRESSIVE, 1}),
      encoded(".png", CV_16UC1)};
  for (const auto& bytes : pictures) {
    EXPECT_TRUE(is_whole_picture(bytes));
    for (std::size_t size = 9; size + 4 < bytes.size(); ++size)
      ASSERT_FALSE(is_whole_picture(std::span(bytes).first(size))) << size;
  }
}

TEST(PictureFile, ReadsColourAndDepth) {
  const test::TemporaryFolder folder;
  const auto color = read_color_picture(stored(folder, encoded(".jpg", CV_8UC3)), {64, 48});
  ASSERT_TRUE(color) << color.error();
  EXPECT_EQ(color->type(), CV_8UC3);
  const auto depth = read_depth_picture(stored(folder, encoded(".png", CV_16UC1)), {64, 48});
  ASSERT_TRUE(depth) << depth.error();
  EXPECT_EQ(cv::norm(*depth, noise(CV_16UC1), cv::NORM_INF), 0);
}

TEST(PictureFile, SaysWhatIsWrong) {
  const test::TemporaryFolder folder;
  const auto jpeg = encoded(".jpg", CV_8UC3);
  const std::vector<std::uint8_t> text{'h', 'i'};
  EXPECT_THAT(read_color_picture(folder / "none.jpg", {64, 48}).error(), HasSubstr("none.jpg: no such file"));
  EXPECT_THAT(read_color_picture(folder.path(), {64, 48}).error(), HasSubstr("no such file"));
  EXPECT_THAT(read_color_picture(stored(folder, std::span(jpeg).first(900)), {64, 48}).error(),
              HasSubstr("picture: truncated"));
  EXPECT_THAT(read_color_picture(stored(folder, jpeg), {640, 480}).error(),
              AllOf(HasSubstr("64×48"), HasSubstr("640×480")));
  EXPECT_THAT(read_color_picture(stored(folder, text), {64, 48}).error(), HasSubstr("cannot be decoded"));
  EXPECT_THAT(read_color_picture(stored(folder, {}), {64, 48}).error(), HasSubstr("empty"));
  EXPECT_THAT(read_depth_picture(stored(folder, encoded(".png", CV_8UC1)), {64, 48}).error(),
              HasSubstr("16 bits"));
  EXPECT_THAT(read_depth_picture(stored(folder, encoded(".png", CV_16UC3)), {64, 48}).error(),
              HasSubstr("3 channel"));
}

TEST(PictureFile, SurvivesEveryFlippedByteOfAPng) {
  const test::TemporaryFolder folder;
  const auto good = encoded(".png", CV_16UC1);
  for (std::size_t i = 0; i < 60; ++i) {  // signature, header and the start of the data
    auto bytes = good;
    bytes[i] ^= 0x55;
    const auto read = read_depth_picture(stored(folder, bytes), {64, 48});
    EXPECT_TRUE(!read || read->type() == CV_16UC1);
  }
}

}  // namespace
}  // namespace rds::image
