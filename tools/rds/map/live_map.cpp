// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/map/live_map.hpp"

#include <mutex>
#include <span>

#include <fmt/format.h>

#include "common/topics/endpoints.hpp"
#include "octomap_msgs/msg/Octomap.h"
#include "rds_msgs/msg/MapInfo.h"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "tools/rds/cli/wait.hpp"

namespace rds::tools {
namespace {
using Octomap = octomap_msgs::msg::Octomap;
using MapInfo = rds_msgs::msg::MapInfo;
using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kInfoTime{1500};  // in which a mapper that is there sends both anew

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

}  // namespace

tl::expected<LiveMap, std::string> take_live_map(bus::Participant& participant,
                                                 std::chrono::duration<double> timeout,
                                                 const std::stop_token& stop) {
  const Newest full(participant, topics::kMapFull);
  const Newest info(participant, topics::kMapInfo);
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout);
  if (!wait_until(deadline, stop, [&] { return full.get() != nullptr; }))
    return tl::unexpected(fmt::format("{}: no map in {} s, expected a running rds-mapper",
                                      topics::kMapFull.name, timeout.count()));
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

}  // namespace rds::tools
