// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/map/live_map.hpp"

#include <algorithm>
#include <mutex>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "common/topics/endpoints.hpp"
#include "octomap_msgs/msg/Octomap.h"
#include "rds_msgs/msg/MapInfo.h"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "services/mapper/reader/map_follower.hpp"
#include "tools/rds/cli/wait.hpp"

namespace rds::tools {
namespace {
using Octomap = octomap_msgs::msg::Octomap;
using MapInfo = rds_msgs::msg::MapInfo;
using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kInfoTime{1500};   // in which a mapper that is there sends both anew
constexpr std::chrono::milliseconds kOfferTime{2000};  // … says on which machine it is

/// The newest message of a topic.
template <class Message>
class Newest {
 public:
  Newest(bus::Participant& participant, const topics::Topic<Message>& topic)
      : subscription_(
            topics::subscribe(participant, topic, topics::kTool, [this](std::shared_ptr<const Message> m) {
              const std::lock_guard lock(mutex_);
              message_ = std::move(m);
            })) {}
  std::shared_ptr<const Message> get() const {
    const std::lock_guard lock(mutex_);
    return message_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const Message> message_;
  bus::Subscription subscription_;  // last: its callback uses the others
};

tl::expected<std::unique_ptr<octomap::ColorOcTree>, std::string> decode(const Octomap& message) {
  if (message.id() != "ColorOcTree" || message.binary())
    return tl::unexpected(fmt::format("{}: a {} tree of type '{}', expected a full ColorOcTree",
                                      topics::kMapFull.name, message.binary() ? "binary" : "full",
                                      message.id()));
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(message.data().data());
  auto tree = mapper::tree_from_bytes({bytes, message.data().size()}, message.resolution());
  if (!tree) return tl::unexpected(fmt::format("{}: {}", topics::kMapFull.name, tree.error()));
  return tree;
}

bool belong_together(const Octomap& full, const MapInfo* info) {
  return info != nullptr && info->describes_full() && info->header().stamp() == full.header().stamp();
}

/// False also for one that does not say where it is.
bool is_mapper_elsewhere(bus::Participant& participant, Clock::time_point deadline,
                         const std::stop_token& stop) {
  const Newest offers(participant, topics::kMapOffers);
  wait_until(std::min(deadline, Clock::now() + kOfferTime), stop, [&] { return offers.get() != nullptr; });
  return offers.get() != nullptr && offers.get()->host() != transfer::this_host();
}

tl::expected<LiveMap, std::string> take_from_afar(bus::Participant& participant, Clock::time_point deadline,
                                                  const std::stop_token& stop) {
  service::Diagnostics diagnostics;
  service::ServiceContext context{"rds-map", participant, diagnostics};
  const mapper::MapFollower follower(context);
  std::optional<LiveMap> map;
  const auto take = [&](const mapper::OctreeReplica& replica, const std::vector<std::string>& labels) {
    map.emplace(LiveMap{std::make_unique<octomap::ColorOcTree>(replica.tree()), replica.map_epoch(),
                        replica.revision(), labels});
  };
  if (!wait_until(deadline, stop, [&] { return follower.map().look(take); }))
    return tl::unexpected(fmt::format("{}: no map in time from rds-mapper on another machine",
                                      topics::kMapOffers.name));
  return std::move(*map);
}

tl::expected<LiveMap, std::string> take_from_topics(bus::Participant& participant, Clock::time_point deadline,
                                                    const std::stop_token& stop) {
  const Newest full(participant, topics::kMapFull);
  const Newest info(participant, topics::kMapInfo);
  if (!wait_until(deadline, stop, [&] { return full.get() != nullptr; }))
    return tl::unexpected(
        fmt::format("{}: no map in time, expected a running rds-mapper", topics::kMapFull.name));
  wait_until(Clock::now() + kInfoTime, stop, [&] { return belong_together(*full.get(), info.get().get()); });
  auto tree = decode(*full.get());
  if (!tree) return tl::unexpected(tree.error());
  LiveMap map{std::move(*tree), 0, 0, {}};
  if (const auto told = info.get()) {
    map.map_epoch = told->map_epoch();
    map.revision = told->revision();
    map.labels = told->labels();
  }
  return map;
}

}  // namespace

tl::expected<LiveMap, std::string> take_live_map(bus::Participant& participant,
                                                 std::chrono::duration<double> timeout,
                                                 const std::stop_token& stop) {
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout);
  const bool elsewhere = is_mapper_elsewhere(participant, deadline, stop);
  auto map = elsewhere ? take_from_afar(participant, deadline, stop)
                       : take_from_topics(participant, deadline, stop);
  if (!map) return tl::unexpected(fmt::format("{} ({} s)", map.error(), timeout.count()));
  return map;
}

}  // namespace rds::tools
