// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/dataset_check.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/image/tum_dataset.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/recording/conversion.hpp"
#include "tools/recording/open_recording.hpp"

namespace rds::doctor {
namespace {
using testing::HasSubstr;

class DatasetCheckTest : public testing::Test {
 protected:
  void SetUp() override { test::make_small_dataset(folder.path(), 12); }
  [[nodiscard]] image::TumDataset open() const { return image::TumDataset::open(folder.path()).value(); }
  [[nodiscard]] std::filesystem::path color(std::size_t frame) const {
    return open().color_list().entries.at(frame).picture;
  }
  [[nodiscard]] Finding finding_about(const std::string& subject) const {
    const auto findings = check_dataset(open(), 1);
    const auto found = std::ranges::find(findings, subject, &Finding::subject);
    return found == findings.end() ? Finding{Verdict::kFault, "", "not checked"} : *found;
  }
  test::TemporaryFolder folder;
};

TEST_F(DatasetCheckTest, FindsNothingWrongWithAGoodRecording) {
  const auto findings = check_dataset(open(), 1);
  EXPECT_EQ(findings.size(), 17U);
  EXPECT_TRUE(std::ranges::all_of(findings, [](const auto& f) { return f.verdict == Verdict::kGood; }))
      << to_text(findings);
}

TEST_F(DatasetCheckTest, LooksAtEveryNthFrameOnce) {
  const auto looks = look_at_pictures(open(), 3);
  EXPECT_EQ(looks.frames.size(), 4U);
  EXPECT_EQ(looks.edges.size(), 4U);
  EXPECT_NEAR(looks.frames.front().depth.median_m, 2.0, 0.2);
  EXPECT_TRUE(std::isnan(looks.frames.front().color_change));
  EXPECT_GT(looks.frames.back().color_change, 1);
}

TEST_F(DatasetCheckTest, FindsTheSameInABag) {
  const auto writer = recording::make_bag_writer(folder / "a.mcap", mcap::Compression::kLz4).value();
  ASSERT_TRUE(recording::write_bag(open(), *writer));
  const auto bag = recording::open_recording(folder / "a.mcap").value();
  EXPECT_EQ(to_text(check_dataset(*bag.recording, 1)), to_text(check_dataset(open(), 1)));
}

TEST_F(DatasetCheckTest, CountsMissingPictures) {
  std::filesystem::remove(color(4));
  EXPECT_THAT(finding_about("files").sentence, HasSubstr("1 of 24 listed pictures are missing"));
  EXPECT_THAT(finding_about("pictures").sentence, HasSubstr("1 of 12 frames cannot be read"));
  EXPECT_EQ(finding_about("pictures").verdict, Verdict::kHint);
}

TEST_F(DatasetCheckTest, NamesATornPicture) {
  std::filesystem::resize_file(color(4), std::filesystem::file_size(color(4)) / 2);
  EXPECT_THAT(finding_about("pictures").sentence, HasSubstr("truncated after"));
}

TEST_F(DatasetCheckTest, FindsFrozenPictures) {
  for (std::size_t i = 6; i < 12; ++i)
    std::filesystem::copy_file(color(5), color(i), std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(finding_about("frozen").sentence, HasSubstr("6 of 12 frames"));
  EXPECT_EQ(finding_about("frozen depth").verdict, Verdict::kGood);
}

TEST_F(DatasetCheckTest, SaysThatPicturesAreOfAnotherSize) {
  auto camera = test::read_text(folder / "camera.yaml");
  camera.replace(camera.find("64"), 2, "96");
  test::write_text(folder / "camera.yaml", camera);
  EXPECT_EQ(finding_about("pictures").verdict, Verdict::kFault);
  EXPECT_THAT(finding_about("pictures").sentence, HasSubstr("64×48 px, expected 96×48"));
}

}  // namespace
}  // namespace rds::doctor
