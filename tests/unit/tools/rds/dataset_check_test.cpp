// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/dataset_check.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::tools {
namespace {
using testing::HasSubstr;

Finding finding_about(const std::string& subject, const std::vector<Finding>& findings) {
  const auto found = std::ranges::find(findings, subject, &Finding::subject);
  return found == findings.end() ? Finding{Verdict::kFault, "", "not checked"} : *found;
}

DatasetLooks good_looks(std::size_t frames) {
  DatasetLooks looks;
  for (std::size_t i = 0; i < frames; ++i)
    looks.frames.push_back({static_cast<std::int64_t>(i), 120, 300, 4, 0.9, 2.0});
  return looks;
}

class DatasetCheckTest : public testing::Test {
 protected:
  void SetUp() override { test::make_small_dataset(folder.path(), 20); }
  image::TumDataset open() const { return image::TumDataset::open(folder.path()).value(); }
  test::TemporaryFolder folder;
};

TEST_F(DatasetCheckTest, FindsNothingWrongWithAGoodRecording) {
  const auto dataset = open();
  auto findings = check_lists(dataset);
  for (const auto& f : check_looks(look_at_pictures(dataset, 1), dataset.depth_scale()))
    findings.push_back(f);
  EXPECT_EQ(findings.size(), 11U);
  EXPECT_TRUE(std::ranges::all_of(findings, [](const auto& f) { return f.verdict == Verdict::kGood; }))
      << to_text(findings);
}

TEST_F(DatasetCheckTest, MeasuresDepthInMetres) {
  const auto looks = look_at_pictures(open(), 3);
  EXPECT_EQ(looks.frames.size(), 7U);
  EXPECT_NEAR(looks.frames.front().median_depth_m, 2.0, 0.2);
  EXPECT_NEAR(looks.frames.front().depth_share, 1.0, 1e-9);
}

TEST_F(DatasetCheckTest, CountsPicturesThatCannotBeRead) {
  const auto dataset = open();
  std::filesystem::remove(dataset.frames()[4].color_path);
  const auto finding = finding_about("pictures", check_looks(look_at_pictures(dataset, 1), 1000));
  EXPECT_EQ(finding.verdict, Verdict::kHint);
  EXPECT_THAT(finding.sentence, HasSubstr("1 of 20"));
}

TEST_F(DatasetCheckTest, FindsGapsAndMissingTruth) {
  test::write_text(folder / "rgb.txt", "10.0 rgb/a\n10.033 rgb/b\n10.066 rgb/c\n11.0 rgb/d\n");
  test::write_text(folder / "depth.txt", "10.0 d/a\n10.033 d/b\n10.066 d/c\n11.0 d/d\n");
  std::filesystem::remove(folder / "groundtruth.txt");
  const auto findings = check_lists(open());
  EXPECT_EQ(finding_about("gaps", findings).verdict, Verdict::kFault);
  EXPECT_THAT(finding_about("gaps", findings).sentence, HasSubstr("1 gaps, the longest 934 ms after 10.066"));
  EXPECT_EQ(finding_about("ground truth", findings).verdict, Verdict::kHint);
}

TEST(CheckLooks, FindsADepthScaleThatCannotBe) {
  auto looks = good_looks(10);
  for (auto& frame : looks.frames) frame.median_depth_m = 2.0 / 50;
  const auto finding = finding_about("depth scale", check_looks(looks, 50000));
  EXPECT_EQ(finding.verdict, Verdict::kFault);
  EXPECT_THAT(finding.sentence, HasSubstr("1000 would give 2.00 m"));
}

TEST(CheckLooks, TellsFewBadFramesFromMany) {
  auto looks = good_looks(100);
  looks.frames[50].change = 0;
  looks.frames[60].sharpness = 10;
  for (std::size_t i = 0; i < 20; ++i) looks.frames[i].brightness = 5;
  const auto findings = check_looks(looks, 1000);
  EXPECT_EQ(finding_about("frozen", findings).verdict, Verdict::kHint);
  EXPECT_EQ(finding_about("blur", findings).verdict, Verdict::kHint);
  EXPECT_EQ(finding_about("darkness", findings).verdict, Verdict::kFault);
  EXPECT_EQ(finding_about("brightness", findings).verdict, Verdict::kGood);
}

TEST(CheckLooks, OfNoReadableFrameIsAFault) {
  DatasetLooks looks;
  looks.unreadable.push_back("a.png: truncated");
  EXPECT_TRUE(any_fault(check_looks(looks, 1000)));
}

}  // namespace
}  // namespace rds::tools
