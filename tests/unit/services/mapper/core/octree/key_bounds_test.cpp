// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree/key_bounds.hpp"

#include <gtest/gtest.h>

namespace rds::mapper {
namespace {

using Keys = std::array<std::uint16_t, 3>;

TEST(KeyBounds, GrowAndShrinkWithTheVoxels) {
  KeyBounds bounds;
  bounds.add({5, 100, 65535});
  bounds.add({7, 90, 0});
  bounds.add({7, 95, 12});
  EXPECT_EQ(bounds.lowest(), (Keys{5, 90, 0}));
  EXPECT_EQ(bounds.highest(), (Keys{7, 100, 65535}));
  bounds.remove({5, 100, 65535});
  EXPECT_EQ(bounds.lowest(), (Keys{7, 90, 0}));
  EXPECT_EQ(bounds.highest(), (Keys{7, 95, 12}));
  bounds.remove({7, 90, 0});
  bounds.remove({7, 95, 12});
  bounds.add({3, 3, 3});
  EXPECT_EQ(bounds.lowest(), (Keys{3, 3, 3}));
  EXPECT_EQ(bounds.highest(), (Keys{3, 3, 3}));
}

}  // namespace
}  // namespace rds::mapper
