// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/item_store.hpp"

#include <map>
#include <memory>

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
  EXPECT_EQ(offers.at(Stream::kKeyframeFeatures).lost, 0U) << "none that is older";
  EXPECT_EQ(store.lost(Stream::kKeyframeFeatures), 1U);
  EXPECT_TRUE(store.is_lost(Stream::kKeyframeFeatures, 6));
  EXPECT_FALSE(store.is_lost(Stream::kKeyframeFeatures, 4)) << "there never was one";
  EXPECT_FALSE(store.is_lost(Stream::kKeyframeImages, 6));
  store.put(Stream::kKeyframeFeatures, 6, Bytes(10, 1));
  EXPECT_EQ(store.lost(Stream::kKeyframeFeatures), 0U);
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

/// As a disk that may be full, or give back nothing.
class Disk : public ItemSpill {
 public:
  explicit Disk(std::map<std::pair<Stream, std::uint64_t>, Bytes>& items) : items_(items) {}
  bool put(Stream stream, std::uint64_t number, const Bytes& item) override {
    if (items_.size() < kRoom) items_[{stream, number}] = item;
    return items_.contains({stream, number});
  }
  std::optional<Bytes> get(Stream stream, std::uint64_t number) override {
    const auto item = items_.find({stream, number});
    return item == items_.end() ? std::nullopt : std::optional(item->second);
  }
  void erase(Stream stream, std::uint64_t number) override { items_.erase({stream, number}); }
  void clear() override { items_.clear(); }

  static constexpr std::size_t kRoom = 6;

 private:
  std::map<std::pair<Stream, std::uint64_t>, Bytes>& items_;
};

class SpillingStore : public testing::Test {
 protected:
  void put(std::uint64_t first, std::uint64_t last, std::size_t bytes = 40) {
    for (std::uint64_t number = first; number <= last; ++number)
      store_.put(Stream::kKeyframeImages, number, Bytes(bytes, static_cast<std::uint8_t>(number)));
  }
  bool has(std::uint64_t number, std::size_t bytes = 40) {
    const Bytes* item = store_.find(Stream::kKeyframeImages, number);
    return item != nullptr && *item == Bytes(bytes, static_cast<std::uint8_t>(number));
  }
  Offer offer() const { return store_.offers().at(Stream::kKeyframeImages); }

  std::map<std::pair<Stream, std::uint64_t>, Bytes> disk_;
  ItemStore store_{100, std::make_unique<Disk>(disk_), 160};
};

TEST_F(SpillingStore, KeepsOlderItemsOnTheDisk) {
  put(1, 5);
  EXPECT_EQ(disk_.size(), 3U);
  for (std::uint64_t number = 1; number <= 5; ++number) EXPECT_TRUE(has(number)) << number;
  EXPECT_EQ(offer().oldest, 1U);
  EXPECT_EQ(offer().newest, 5U);
  put(6, 7);
  EXPECT_FALSE(has(1)) << "there is room for four on the disk";
  EXPECT_TRUE(has(2));
  EXPECT_EQ(offer().oldest, 2U);
  EXPECT_EQ(disk_.size(), 4U);
}

TEST_F(SpillingStore, CountsWhatIsLost) {
  put(1, 2);
  put(3, 3, 0);  // cannot be made
  put(4, 8);
  EXPECT_EQ(offer(), (Offer{2, 8, 1})) << "there is room for two and four; the third never came";
  EXPECT_EQ(store_.lost(Stream::kKeyframeImages), 2U);
  EXPECT_TRUE(store_.is_lost(Stream::kKeyframeImages, 1));
  EXPECT_TRUE(store_.is_lost(Stream::kKeyframeImages, 3));
  EXPECT_FALSE(store_.is_lost(Stream::kKeyframeImages, 2));
  put(9, 12);
  EXPECT_EQ(offer(), (Offer{7, 12, 6}));
  EXPECT_TRUE(store_.is_lost(Stream::kKeyframeImages, 3));
  disk_.erase({Stream::kKeyframeImages, 8});
  EXPECT_FALSE(has(8));
  EXPECT_EQ(offer(), (Offer{7, 12, 6}));
  EXPECT_EQ(store_.lost(Stream::kKeyframeImages), 7U);
  EXPECT_TRUE(store_.is_lost(Stream::kKeyframeImages, 8));
  store_.clear();
  EXPECT_FALSE(store_.is_lost(Stream::kKeyframeImages, 3));
}

TEST_F(SpillingStore, ForgetsWhatTheDiskDoesNotTakeOrGiveBack) {
  put(1, 3);
  disk_.clear();
  EXPECT_FALSE(has(1));
  EXPECT_EQ(offer().oldest, 2U);
  for (std::uint64_t number = 100; disk_.size() < Disk::kRoom; ++number)
    disk_[{Stream::kKeyframeFeatures, number}] = {};
  put(4, 4);
  EXPECT_FALSE(has(2)) << "the disk is full";
  EXPECT_TRUE(has(3));
  EXPECT_EQ(offer().oldest, 3U);
}

TEST_F(SpillingStore, TakesANewItemInPlaceOfAnOldOne) {
  put(1, 4);
  EXPECT_TRUE(has(1));
  put(1, 1, 30);  // older than all in memory: it goes to the disk again
  EXPECT_TRUE(has(1, 30));
  put(5, 9);
  EXPECT_FALSE(has(1, 30));
  store_.clear();
  EXPECT_TRUE(store_.offers().empty());
  EXPECT_TRUE(disk_.empty());
  put(1, 3);
  EXPECT_TRUE(has(1)) << "and nothing of before";
}

}  // namespace
}  // namespace rds::transfer
