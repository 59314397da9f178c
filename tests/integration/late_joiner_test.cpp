// SPDX-License-Identifier: Apache-2.0
// A subscriber that joins in the middle rebuilds the map from full map and deltas: the mapper's own tree, bit
// for bit.
#include <map>
#include <mutex>

#include <gmock/gmock.h>

#include "common/bus/participant.hpp"
#include "common/messages/conversions.hpp"
#include "octomap_msgs/msg/Octomap.h"
#include "rds_msgs/msg/MapInfo.h"
#include "rds_msgs/msg/OctreeDelta.h"
#include "services/mapper/core/map_files.hpp"
#include "services/mapper/core/octree_replica.hpp"
#include "services/mapper/core/tree_bytes.hpp"
#include "tests/integration/run_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;

constexpr int kDomain = 24;

mapper::MapDelta to_delta(const rds_msgs::msg::OctreeDelta& m) {
  mapper::MapDelta delta;
  delta.map_epoch = m.map_epoch();
  delta.base_revision = m.base_revision();
  delta.revision = m.revision();
  delta.resolution = m.resolution();
  delta.keys = m.keys();
  delta.log_odds = m.log_odds();
  delta.labels = m.labels();
  delta.colors = m.colors();
  delta.deleted_keys = m.deleted_keys();
  return delta;
}

/// What a program of somebody else would do with the two topics.
class MapReader {
 public:
  MapReader(bus::Vendor vendor, int domain)
      : bus_(bus::Participant::create(
            {.vendor = vendor, .domain = domain, .node_name = "reader", .loopback_only = true})) {
    subscriptions_.push_back(bus_->subscribe<octomap_msgs::msg::Octomap>(
        "rds/map/full", bus::kLatched, [this](const auto& m) { on_full(m); }));
    subscriptions_.push_back(bus_->subscribe<rds_msgs::msg::MapInfo>("rds/map/info", bus::kLatchedEvery,
                                                                     [this](const auto& m) { on_info(m); }));
    subscriptions_.push_back(bus_->subscribe<rds_msgs::msg::OctreeDelta>(
        "rds/map/delta", bus::kDelta, [this](const auto& m) { on_delta(*m); }));
  }

  std::vector<std::uint8_t> bytes() {
    const std::lock_guard lock(mutex_);
    return replica_.is_valid() ? mapper::to_bytes(replica_.tree()) : std::vector<std::uint8_t>{};
  }
  int full_maps() {
    const std::lock_guard lock(mutex_);
    return full_maps_;
  }
  int deltas() {
    const std::lock_guard lock(mutex_);
    return deltas_;
  }

 private:
  void on_full(std::shared_ptr<const octomap_msgs::msg::Octomap> m) {
    const std::lock_guard lock(mutex_);
    full_ = std::move(m);
    take_full();
  }
  void on_info(std::shared_ptr<const rds_msgs::msg::MapInfo> m) {
    const std::lock_guard lock(mutex_);
    infos_[messages::to_nanoseconds(m->header().stamp())] = std::move(m);
    take_full();
  }
  void on_delta(const rds_msgs::msg::OctreeDelta& m) {
    const std::lock_guard lock(mutex_);
    waiting_[m.base_revision()] = to_delta(m);
    apply_waiting();
  }
  /// A gap in the deltas is closed by the next full map.
  void take_full() {
    if (!full_) return;
    const auto info = infos_.find(messages::to_nanoseconds(full_->header().stamp()));
    if (info == infos_.end()) return;
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(full_->data().data());
    const auto answer =
        replica_.apply_full({bytes, full_->data().size()}, full_->resolution(), info->second->map_epoch(),
                            info->second->revision(), info->second->labels());
    if (answer.status == mapper::ReplicaStatus::kApplied) ++full_maps_;
    full_.reset();
    apply_waiting();
  }
  void apply_waiting() {
    while (replica_.is_valid()) {
      const auto next = waiting_.find(replica_.revision());
      if (next == waiting_.end() || replica_.apply(next->second).status != mapper::ReplicaStatus::kApplied)
        return;
      ++deltas_;
    }
  }

  std::mutex mutex_;
  mapper::OctreeReplica replica_;
  std::shared_ptr<const octomap_msgs::msg::Octomap> full_;
  std::map<std::int64_t, std::shared_ptr<const rds_msgs::msg::MapInfo>> infos_;
  std::map<std::uint64_t, mapper::MapDelta> waiting_;
  int full_maps_ = 0;
  int deltas_ = 0;
  std::unique_ptr<bus::Participant> bus_;
  std::vector<bus::Subscription> subscriptions_;  // last: callbacks use the members above
};

TEST(LateJoiner, RebuildsTheMappersTreeFromFullMapAndDeltasOverEitherBus) {
  RDS_REQUIRE_SHARED("data/7scenes_kitchen");
  const TemporaryFolder place;
  make_excerpt(shared() / "data/7scenes_kitchen", place / "data", 200);
  Process process({rds(), "run", "--dataset", (place / "data").string(), "--out", (place / "out").string(),
                   "--domain", std::to_string(kDomain), "--no-dynamics"});
  ASSERT_TRUE(process.wait_for_output("frame 6", 60s)) << process.standard_error();  // in the middle
  MapReader fast(bus::Vendor::kFastDds, kDomain);
  MapReader cyclone(bus::Vendor::kCycloneDds, kDomain);
  EXPECT_EQ(process.wait(120s), 0) << process.standard_error();
  const auto saved = mapper::read_tree(place / "out" / "map.ot");
  ASSERT_TRUE(saved) << saved.error();
  const auto expected = mapper::to_bytes(**saved);
  for (MapReader* reader : {&fast, &cyclone}) {
    EXPECT_GT(reader->full_maps(), 0);
    EXPECT_GT(reader->deltas(), 0);
    EXPECT_TRUE(reader->bytes() == expected) << (reader == &fast ? "Fast DDS" : "Cyclone DDS");
  }
}

}  // namespace
}  // namespace rds::test
