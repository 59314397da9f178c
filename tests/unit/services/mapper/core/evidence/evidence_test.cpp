// SPDX-License-Identifier: Apache-2.0
// Whatever the order in which keyframes come, go and come again: the map is a function of those that are
// there.
#include "services/mapper/core/evidence/evidence.hpp"

#include <algorithm>
#include <numeric>

#include "services/mapper/core/scan/contribution.hpp"
#include "tests/unit/services/mapper/core/random_keyframes.hpp"

namespace rds::mapper {
namespace {

constexpr std::size_t kKeyframes = 8;

MapperConfig coarse() {
  MapperConfig config;
  config.octree.resolution_m = 0.1;
  config.sampling.stride_px = 4;
  return config;
}

/// Records of random keyframes, each with a pose it comes with and its final one.
struct Records {
  explicit Records(unsigned seed) {
    test::RandomKeyframes random(seed, {"person", "chair", "sofa"});
    for (std::size_t i = 0; i < kKeyframes; ++i) {
      records.push_back(test::record_of(random.next(), labels, config));
      final_poses.push_back(random.pose());
    }
  }
  [[nodiscard]] KeyframeRecord corrected(std::size_t i) const {
    KeyframeRecord record = records[i];
    record.map_from_camera = final_poses[i];
    return record;
  }

  MapperConfig config = coarse();
  LabelTable labels;
  std::vector<KeyframeRecord> records;
  std::vector<geometry::Pose> final_poses;
};

/// Evidence with the map that shows it.
class ShownEvidence {
 public:
  explicit ShownEvidence(const Records& all) : all_(all) {}

  void add(const KeyframeRecord& record) {
    evidence_.add(record.id, record.time_ns,
                  contribution_of(record, all_.config.octree, all_.config.sampling, scan_));
  }
  void remove(const KeyframeRecord& record) { evidence_.remove(record.id); }
  void show() { evidence_.update(shown()); }
  std::vector<std::uint8_t> bytes() {
    evidence_.update_all(shown());
    return to_bytes(octree_.tree());
  }
  [[nodiscard]] const SemanticOctree& octree() const { return octree_; }

 private:
  Evidence::Show shown() {
    return [this](const octomap::OcTreeKey& key, const EvidenceBlock& block, const BlockMask& changed) {
      MapDelta unused;
      octree_.show(key, block, changed, all_.labels, unused);
    };
  }
  const Records& all_;
  Scan scan_;
  Evidence evidence_{all_.config.confirmation.apart_s};
  SemanticOctree octree_{all_.config.octree};
};

std::vector<std::uint8_t> bytes_in_order(const Records& all) {
  ShownEvidence map(all);
  for (std::size_t i = 0; i < kKeyframes; ++i) map.add(all.corrected(i));
  return map.bytes();
}

TEST(Evidence, IsAFunctionOfItsKeyframesInTwoHundredSchedules) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Records all(seed);
    const auto expected = bytes_in_order(all);
    EXPECT_GT(expected.size(), 1000U);
    for (unsigned schedule = 0; schedule < 10; ++schedule) {
      std::mt19937 random(100 * seed + schedule);
      std::vector<std::size_t> order(kKeyframes);
      std::iota(order.begin(), order.end(), 0U);
      std::ranges::shuffle(order, random);
      ShownEvidence map(all);
      for (const std::size_t i : order) {
        map.add(all.records[i]);
        if (random() % 2 == 0) map.show();
      }
      std::ranges::shuffle(order, random);
      for (const std::size_t i : order) {
        map.remove(all.records[i]);
        if (random() % 2 == 0) map.show();
        map.add(all.corrected(i));
        if (random() % 2 == 0) map.show();
      }
      ASSERT_TRUE(map.bytes() == expected) << "seed " << seed << ", schedule " << schedule;
    }
  }
}

TEST(Evidence, WithoutKeyframesThereIsNoMap) {
  const Records all(1);
  ShownEvidence map(all);
  for (const auto& record : all.records) map.add(record);
  EXPECT_FALSE(map.bytes().empty());
  for (const auto& record : all.records) map.remove(record);
  EXPECT_TRUE(map.bytes().empty());
  EXPECT_EQ(map.octree().tree().size(), 0U);
}

TEST(Evidence, FinalKeyframesOutlastTheirBytes) {
  const Records all(3);
  const auto show = [&](Evidence& from, SemanticOctree& octree) {
    from.update_all([&](const octomap::OcTreeKey& key, const EvidenceBlock& block, const BlockMask& changed) {
      MapDelta unused;
      octree.show(key, block, changed, all.labels, unused);
    });
    return to_bytes(octree.tree());
  };
  Scan scan;
  Evidence evidence(1);
  SemanticOctree octree(all.config.octree);
  for (const auto& record : all.records)
    evidence.add(record.id, record.time_ns,
                 contribution_of(record, all.config.octree, all.config.sampling, scan));
  const auto before = show(evidence, octree);
  EXPECT_GT(before.size(), 1000U);
  for (std::size_t i = 0; i < kKeyframes; ++i) evidence.make_final(i);
  EXPECT_TRUE(show(evidence, octree) == before);
  map_file::ByteWriter writer;
  evidence.final_map().put(writer);
  const auto bytes = writer.take();
  map_file::ByteReader reader(bytes);
  Evidence restored(1);
  restored.begin_with(FinalMap::get(reader, all.labels.names().size()));
  ASSERT_TRUE(reader.finish());
  SemanticOctree restored_octree(all.config.octree);
  EXPECT_TRUE(show(restored, restored_octree) == before);
}

}  // namespace
}  // namespace rds::mapper
