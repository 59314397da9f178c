// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/objects/label_distribution.hpp"

#include <gmock/gmock.h>

namespace rds::mapper {
namespace {

double probability(const LabelDistribution& labels, const std::string& label) {
  for (const LabelBelief& belief : labels.beliefs(100))
    if (belief.label == label) return belief.probability;
  return 0;
}

TEST(LabelDistribution, TwoSightingsMakeALabelAsProbableAsTheirScore) {
  LabelDistribution labels;  // two count as one that is independent
  labels.add("chair", 0.8);
  labels.add("chair", 0.8);
  EXPECT_NEAR(probability(labels, "chair"), 0.8, 1e-9);
}

TEST(LabelDistribution, AWrongFirstLabelIsOutweighed) {
  LabelDistribution labels;
  for (int i = 0; i < 4; ++i) labels.add("sofa", 0.7);
  EXPECT_EQ(labels.best(), "sofa");
  for (int i = 0; i < 5; ++i) labels.add("chair", 0.7);
  EXPECT_EQ(labels.best(), "chair");
  EXPECT_GT(probability(labels, "chair"), 3 * probability(labels, "sofa"));
}

TEST(LabelDistribution, ASureSightingWeighsMoreThanAWeakOne) {
  LabelDistribution labels;
  labels.add("sofa", 0.3);
  labels.add("chair", 0.9);
  EXPECT_EQ(labels.best(), "chair");
}

TEST(LabelDistribution, ProbabilitiesLeaveSomethingForWhatWasNeverNamed) {
  LabelDistribution labels;
  labels.add("sofa", 0.0);
  labels.add("chair", 1.0);
  const double named = probability(labels, "sofa") + probability(labels, "chair");
  EXPECT_GT(probability(labels, "sofa"), 0);
  EXPECT_LT(named, 1);
}

TEST(LabelDistribution, StaysFiniteAfterManySightings) {
  LabelDistribution labels;
  labels.add("sofa", 0.9);
  for (int i = 0; i < 100'000; ++i) labels.add("chair", 1.0);
  EXPECT_DOUBLE_EQ(probability(labels, "chair"), 1);
  EXPECT_DOUBLE_EQ(probability(labels, "sofa"), 0);
}

TEST(LabelDistribution, AddsUpWhateverTheOrder) {
  LabelDistribution one;
  one.add("chair", 0.5);
  one.add("sofa", 0.5);
  LabelDistribution other;
  other.add("bench", 0.5);
  other.add("chair", 0.5);
  LabelDistribution sum = one;
  sum.add(other);
  other.add(one);
  EXPECT_EQ(sum.beliefs(5), other.beliefs(5));
  EXPECT_EQ(sum.best(), "chair");
  const auto two = sum.beliefs(2);
  ASSERT_EQ(two.size(), 2U);
  EXPECT_EQ(two[1].label, "bench") << "of equal ones the first by name";
  EXPECT_DOUBLE_EQ(two[0].share, 0.5);
}

TEST(LabelDistribution, BytesComeBackAndImpossibleOnesAreRefused) {
  LabelDistribution labels;
  labels.add("sofa", 0.4);
  labels.add("chair", 0.9);
  map_file::ByteWriter writer;
  labels.put(writer);
  const map_file::Bytes bytes = writer.take();
  map_file::ByteReader reader(bytes);
  EXPECT_EQ(LabelDistribution::get(reader).beliefs(5), labels.beliefs(5));
  EXPECT_TRUE(reader.finish());

  map_file::ByteWriter empty;
  empty.put_count(0);
  const map_file::Bytes none = empty.take();
  map_file::ByteReader of_none(none);
  LabelDistribution::get(of_none);
  EXPECT_THAT(of_none.finish().error(), testing::HasSubstr("an object without a label"));

  map_file::ByteWriter twice;
  twice.put_count(2);
  for (int i = 0; i < 2; ++i) {
    twice.put_text("chair");
    twice.put(1.0);
  }
  const map_file::Bytes same = twice.take();
  map_file::ByteReader of_same(same);
  LabelDistribution::get(of_same);
  EXPECT_THAT(of_same.finish().error(), testing::HasSubstr("labels out of order"));
}

}  // namespace
}  // namespace rds::mapper
