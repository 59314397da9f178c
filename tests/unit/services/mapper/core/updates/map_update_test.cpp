// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/updates/map_update.hpp"

#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <zstd.h>

namespace rds::mapper {
namespace {

using testing::HasSubstr;

MapUpdate example() {
  MapUpdate update{{}, {"", "chair", "table"}};
  MapDelta& delta = update.delta;
  delta.map_epoch = std::numeric_limits<std::uint64_t>::max();
  delta.map_id = 2;
  delta.base_revision = 3;
  delta.revision = 9;
  delta.keyframe_id = 5;
  delta.stamp_ns = -6;
  delta.resolution = 0.05;
  delta.keys = {0, 0, 0, 1, 0, 0, 0, 1, 0, 30000, 40000, 50000, 65535, 65535, 65535};
  delta.log_odds = {0.85F, -0.41F, 3.5F, -2.0F, 0.0F};
  delta.labels = {0, 1, 2, 0, 65535};
  delta.colors = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 255};
  delta.deleted_keys = {7, 7, 7, 65535, 65535, 65535};
  return update;
}

std::vector<std::uint8_t> frame_of(const std::vector<std::uint8_t>& raw) {
  std::vector<std::uint8_t> frame(ZSTD_compressBound(raw.size()));
  frame.resize(ZSTD_compress(frame.data(), frame.size(), raw.data(), raw.size(), 1));
  return frame;
}

std::vector<std::uint8_t> raw_of(const std::vector<std::uint8_t>& frame) {
  std::vector<std::uint8_t> raw(ZSTD_getFrameContentSize(frame.data(), frame.size()));
  ZSTD_decompress(raw.data(), raw.size(), frame.data(), frame.size());
  return raw;
}

TEST(MapUpdate, ComesBackAsItWas) {
  const MapUpdate sent = example();
  const auto came = unpack_update(pack(sent));
  ASSERT_TRUE(came) << came.error();
  EXPECT_EQ(came->labels, sent.labels);
  const MapDelta& a = came->delta;
  const MapDelta& b = sent.delta;
  EXPECT_EQ(std::tie(a.map_epoch, a.map_id, a.base_revision, a.revision, a.keyframe_id, a.stamp_ns,
                     a.resolution, a.keys, a.log_odds, a.labels, a.colors, a.deleted_keys),
            std::tie(b.map_epoch, b.map_id, b.base_revision, b.revision, b.keyframe_id, b.stamp_ns,
                     b.resolution, b.keys, b.log_odds, b.labels, b.colors, b.deleted_keys));
}

TEST(MapUpdate, OfAnotherOrderOrWithArraysThatDoNotFitIsACallersFault) {
  MapUpdate twice = example();
  twice.delta.keys[3] = 0;  // the first voxel again
  EXPECT_THROW(pack(twice), std::invalid_argument);
  MapUpdate torn = example();
  torn.delta.labels.pop_back();
  EXPECT_THROW(pack(torn), std::invalid_argument);
}

TEST(MapUpdate, IsRefusedAtEveryLength) {
  const auto whole = pack(example());
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(unpack_update(std::span(whole).first(size))) << size;
  const auto raw = raw_of(whole);
  for (std::size_t size = 0; size < raw.size(); ++size)
    EXPECT_FALSE(unpack_update(frame_of({raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size)})))
        << size;
  auto longer = raw;
  longer.push_back(0);
  EXPECT_FALSE(unpack_update(frame_of(longer)));
}

TEST(MapUpdate, OfAnyBytesDoesNoHarm) {
  const auto raw = raw_of(pack(example()));
  std::mt19937 random(4);
  std::size_t read = 0;
  for (int i = 0; i < 20'000; ++i) {
    auto spoilt = raw;
    for (int k = 0; k < 3; ++k) spoilt[random() % spoilt.size()] = static_cast<std::uint8_t>(random());
    const auto update = unpack_update(frame_of(spoilt));
    if (!update) continue;
    ++read;
    EXPECT_EQ(update->delta.keys.size(), 3 * update->delta.log_odds.size());
    EXPECT_EQ(update->delta.colors.size(), update->delta.keys.size());
    EXPECT_EQ(update->delta.deleted_keys.size() % 3, 0U);
  }
  EXPECT_GT(read, 0U);  // not only the first check was tried
}

TEST(MapUpdate, IsNotDecodedWhereItSaysThatItIsLargerThanItCanBe) {
  const auto bomb = frame_of(std::vector<std::uint8_t>(std::size_t{64} << 20U));
  EXPECT_LT(bomb.size(), 10'000U);
  EXPECT_THAT(unpack_update(bomb).error(), HasSubstr("larger than any update"));
}

}  // namespace
}  // namespace rds::mapper
