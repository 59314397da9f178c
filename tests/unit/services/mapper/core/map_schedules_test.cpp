// SPDX-License-Identifier: Apache-2.0
// Readers that join late, lose deltas or are restarted, of a mapper that is restarted, too: whoever has the
// mapper's revision has the mapper's tree, bit for bit, label for label.
#include <deque>

#include <gmock/gmock.h>

#include "tests/unit/services/mapper/core/random_keyframes.hpp"

namespace rds::mapper {
namespace {

using test::PublishedMap;
using test::RandomKeyframes;

constexpr int kEvents = 40;
constexpr int kFullMapEvery = 6;           // keyframes
constexpr std::size_t kKeptKeyframes = 3;  // that the bus gives to a mapper that starts again

/// A reader on a wire that loses deltas.
struct Reader {
  OctreeReplica replica;
  bool is_new = true;
  int gaps = 0;
  int compared = 0;

  void take(const MapDelta& delta) {
    const auto status = replica.apply(delta).status;
    gaps += status == ReplicaStatus::kGap || status == ReplicaStatus::kOtherMap ? 1 : 0;
  }
  void restart() {
    replica = OctreeReplica();
    is_new = true;
  }
};

/// One run of mapper and readers, as a seed says.
class Schedule {
 public:
  explicit Schedule(unsigned seed)
      : keyframes_(seed, {"person", "sofa", "couch", "chair"}), config_(config_for(seed)) {}

  void run() {
    for (int i = 0; i < kEvents; ++i) {
      one_event();
      compare();
    }
    publish_full();
    compare();
    for (const Reader& reader : readers_) EXPECT_EQ(reader.replica.revision(), mapper_.map().revision);
  }
  [[nodiscard]] const std::array<Reader, 3>& readers() const { return readers_; }
  [[nodiscard]] int restarts() const { return restarts_; }

 private:
  static MapperConfig config_for(unsigned seed) {
    MapperConfig config;
    config.octree.resolution_m = 0.15;
    config.octree.color_by_label = seed % 2 == 0;
    config.correction.max_keyframes = seed % 3 == 0 ? 5 : 1000;
    return config;
  }

  void one_event() {
    const double which = keyframes_.uniform();
    if (which < 0.08) return restart_mapper(mapper_.map().epoch);
    if (which < 0.12) return restart_mapper(mapper_.map().epoch + 1);  // a tracker that began anew
    if (which < 0.20) return readers_[static_cast<std::size_t>(keyframes_.below(3))].restart();
    if (which < 0.35) return send(mapper_.apply_poses(moved()));
    integrate(keyframes_.next());
  }

  void integrate(const KeyframeInput& input) {
    kept_.push_back(input);
    if (kept_.size() > kKeptKeyframes) kept_.pop_front();
    send(mapper_.integrate(input));
    const bool is_someone_new = std::ranges::any_of(readers_, &Reader::is_new) && keyframes_.uniform() < 0.5;
    if (is_someone_new || ++since_full_ >= kFullMapEvery) publish_full();
  }

  std::vector<KeyframePose> moved() {
    std::vector<KeyframePose> poses;
    for (const KeyframeInput& input : kept_) poses.push_back({input.id, input.stamp_ns, keyframes_.pose()});
    return poses;
  }

  void restart_mapper(std::uint64_t map_epoch) {
    ++restarts_;
    if (map_epoch != mapper_.map().epoch) kept_.clear();
    mapper_ = SemanticMapper(config_, map_epoch);
    ++map_id_;
    for (const KeyframeInput& input : kept_) send(mapper_.integrate(input));
  }

  void send(MapDelta delta) {
    if (delta.is_noop()) return;
    delta.map_id = map_id_;
    for (Reader& reader : readers_)
      if (keyframes_.uniform() > 0.15) reader.take(delta);
  }

  void publish_full() {
    since_full_ = 0;
    const PublishedMap published(mapper_, map_id_);
    for (Reader& reader : readers_) {
      reader.is_new = false;
      const auto status = reader.replica.apply(published.full).status;
      EXPECT_TRUE(status == ReplicaStatus::kApplied || status == ReplicaStatus::kOld);
      EXPECT_EQ(reader.replica.revision(), mapper_.map().revision);
    }
  }

  void compare() {
    for (Reader& reader : readers_) {
      const OctreeReplica& replica = reader.replica;
      if (!replica.is_valid() || replica.map_epoch() != mapper_.map().epoch || replica.map_id() != map_id_ ||
          replica.revision() != mapper_.map().revision)
        continue;
      test::expect_same(replica, mapper_);
      ++reader.compared;
    }
  }

  RandomKeyframes keyframes_;
  MapperConfig config_;
  SemanticMapper mapper_{config_, 100};
  std::uint64_t map_id_ = 1;
  std::deque<KeyframeInput> kept_;
  std::array<Reader, 3> readers_;
  int since_full_ = 0;
  int restarts_ = 0;
};

class MapSchedules : public ::testing::TestWithParam<unsigned> {};

TEST_P(MapSchedules, EveryReaderEndsWithTheMappersTree) {
  Schedule schedule(GetParam());
  schedule.run();
  EXPECT_GT(schedule.restarts(), 0);
  for (const Reader& reader : schedule.readers()) {
    EXPECT_GT(reader.gaps, 0) << "the schedule tests nothing";
    EXPECT_GT(reader.compared, kEvents / 5);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, MapSchedules, ::testing::Range(0U, 20U));

}  // namespace
}  // namespace rds::mapper
