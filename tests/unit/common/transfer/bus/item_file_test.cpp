// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/bus/item_file.hpp"

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace rds::transfer {
namespace {

using Bytes = ItemSpill::Bytes;

TEST(ItemFile, GivesBackWhatItWasGivenAndLeavesNoFile) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(setenv("TMPDIR", folder.path().c_str(), 1), 0);
  ItemFile file;
  EXPECT_EQ(file.get(Stream::kKeyframeImages, 1), std::nullopt);
  ASSERT_TRUE(file.put(Stream::kKeyframeImages, 1, Bytes(200'000, 7)));
  ASSERT_TRUE(file.put(Stream::kKeyframeFeatures, 1, {1, 2, 3}));
  EXPECT_EQ(file.get(Stream::kKeyframeImages, 1), Bytes(200'000, 7));
  EXPECT_EQ(file.get(Stream::kKeyframeFeatures, 1), Bytes({1, 2, 3}));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "it has no name";
  file.erase(Stream::kKeyframeImages, 1);
  EXPECT_EQ(file.get(Stream::kKeyframeImages, 1), std::nullopt);
  file.clear();
  EXPECT_EQ(file.get(Stream::kKeyframeFeatures, 1), std::nullopt);
}

}  // namespace
}  // namespace rds::transfer
