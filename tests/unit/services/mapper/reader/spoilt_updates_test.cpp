// SPDX-License-Identifier: Apache-2.0
// What a reader makes of updates that cannot be right.
#include <atomic>

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/transfer/bus/item_server.hpp"
#include "services/mapper/reader/map_follower.hpp"
#include "tests/unit/services/mapper/mapper_on_the_bus.hpp"

namespace rds::mapper {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint64_t kMapId = 5;
constexpr std::uint64_t kElsewhere = 1;  // a machine

/// An update with a voxel for each revision.
MapUpdate update_of(const UpdateSpan& span) {
  MapUpdate update{{}, {"", "chair"}};
  MapDelta& delta = update.delta;
  delta.map_id = kMapId;
  delta.base_revision = span.since;
  delta.revision = span.until;
  delta.resolution = 0.05;
  for (std::uint64_t x = span.since; x < span.until; ++x) {
    delta.keys.insert(delta.keys.end(), {static_cast<std::uint16_t>(x), 0, 0});
    delta.log_odds.push_back(0.85F);
    delta.labels.push_back(1);
    delta.colors.insert(delta.colors.end(), {1, 2, 3});
  }
  return update;
}

/// A mapper whose whole maps are right and whose steps are not.
class SpoilingMapper : public transfer::ItemMaker {
 public:
  explicit SpoilingMapper(std::function<Bytes(const UpdateSpan&)> step) : step_(std::move(step)) {}

  void reach(std::uint64_t revision) { newest_ = revision; }

  Offers offers(bool /*has_readers*/) override {
    return {kMapId, {{transfer::Stream::kMapUpdates, {1, newest_}}}};
  }
  const Bytes* find(transfer::Stream /*stream*/, std::uint64_t number) override {
    const auto [place, is_new] = made_.try_emplace(number);
    const UpdateSpan span = span_of(number);
    if (is_new) place->second = span.since == 0 ? pack(update_of(span)) : step_(span);
    return place->second.empty() ? nullptr : &place->second;
  }

 private:
  std::function<Bytes(const UpdateSpan&)> step_;
  std::atomic<std::uint64_t> newest_ = 1;
  std::map<std::uint64_t, Bytes> made_;
};

Bytes torn(const UpdateSpan& span) {
  Bytes bytes = pack(update_of(span));
  bytes.resize(bytes.size() / 2);
  return bytes;
}
Bytes of_another_revision(const UpdateSpan& span) {
  return pack(update_of({span.since - 1, span.until}));
}
Bytes of_another_map(const UpdateSpan& span) {
  MapUpdate update = update_of(span);
  update.delta.map_id = kMapId + 1;
  return pack(update);
}
Bytes of_another_resolution(const UpdateSpan& span) {
  MapUpdate update = update_of(span);
  update.delta.resolution = 0.1;
  return pack(update);
}
Bytes without_a_voxel_s_value(const UpdateSpan& span) {
  MapUpdate update = update_of(span);
  update.delta.log_odds[0] = 1e30F;
  return pack(update);
}
Bytes not_to_be_had(const UpdateSpan& /*span*/) {
  return {};
}

struct Spoilt {
  std::string name;
  Bytes (*step)(const UpdateSpan&);
  bool is_counted = true;
};

class SpoiltUpdates : public testing::TestWithParam<Spoilt> {};

TEST_P(SpoiltUpdates, ChangeNothingAndTheWholeMapFollows) {
  const auto mapper_bus = join("mapper");
  const auto reader_bus = join("reader");
  service::Diagnostics diagnostics;
  service::Diagnostics of_reader;
  service::ServiceContext mapper{"rds-mapper", *mapper_bus, diagnostics};
  service::ServiceContext context{"reader", *reader_bus, of_reader};
  SpoilingMapper maker(GetParam().step);
  const transfer::ItemServer server(mapper, topics::kMapper, transfer::kMaps, maker);
  const MapFollower reader(context, kElsewhere);
  for (const std::uint64_t revision : {3U, 6U}) {  // the whole map, a step that is spoilt, the whole map
    maker.reach(revision);
    ASSERT_TRUE(wait_for([&] { return reader.map().place().revision == revision; })) << revision;
  }
  reader.map().look([](const OctreeReplica& replica, const std::vector<std::string>& labels) {
    EXPECT_EQ(replica.tree().getNumLeafNodes(), 6U);
    EXPECT_EQ(labels.size(), 2U);
  });
  EXPECT_EQ(of_reader.rejected() > 0, GetParam().is_counted);
}

INSTANTIATE_TEST_SUITE_P(Each, SpoiltUpdates,
                         testing::Values(Spoilt{"torn", torn},
                                         Spoilt{"of_another_revision", of_another_revision},
                                         Spoilt{"of_another_map", of_another_map},
                                         Spoilt{"of_another_resolution", of_another_resolution},
                                         Spoilt{"without_a_value", without_a_voxel_s_value},
                                         Spoilt{"not_to_be_had", not_to_be_had, false}),
                         [](const auto& test_case) { return test_case.param.name; });

}  // namespace
}  // namespace rds::mapper
