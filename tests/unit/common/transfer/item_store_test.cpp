// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/item_store.hpp"

#include <gtest/gtest.h>

namespace rds::transfer {
namespace {

using Bytes = ItemStore::Bytes;

TEST(ItemStore, OffersWhatItHas) {
  ItemStore store(1000);
  store.put(Stream::kKeyframeImages, 3, Bytes(10, 1));
  store.put(Stream::kKeyframeImages, 5, Bytes(20, 2));
  store.put(Stream::kKeyframeFeatures, 5, Bytes(30, 3));
  store.put(Stream::kKeyframeFeatures, 6, {});
  ASSERT_NE(store.find(Stream::kKeyframeImages, 5), nullptr);
  EXPECT_EQ(*store.find(Stream::kKeyframeImages, 5), Bytes(20, 2));
  EXPECT_EQ(store.find(Stream::kKeyframeImages, 4), nullptr);
  const auto offers = store.offers();
  ASSERT_EQ(offers.size(), 2U);
  EXPECT_EQ(offers.at(Stream::kKeyframeImages).oldest, 3U);
  EXPECT_EQ(offers.at(Stream::kKeyframeImages).newest, 5U);
  EXPECT_EQ(offers.at(Stream::kKeyframeFeatures).newest, 5U) << "what is empty is not there";
  store.clear();
  EXPECT_TRUE(store.offers().empty());
}

TEST(ItemStore, ForgetsTheOldestOfTheStreamThatTakesMost) {
  ItemStore store(100);
  store.put(Stream::kKeyframeFeatures, 1, Bytes(20));
  for (std::uint64_t number = 1; number <= 3; ++number) store.put(Stream::kKeyframeImages, number, Bytes(40));
  EXPECT_EQ(store.find(Stream::kKeyframeImages, 1), nullptr);
  EXPECT_NE(store.find(Stream::kKeyframeImages, 2), nullptr);
  EXPECT_NE(store.find(Stream::kKeyframeFeatures, 1), nullptr);
  store.put(Stream::kKeyframeImages, 3, Bytes(10));  // in place of the other
  store.put(Stream::kKeyframeImages, 4, Bytes(30));
  EXPECT_NE(store.find(Stream::kKeyframeImages, 2), nullptr);
}

}  // namespace
}  // namespace rds::transfer
