// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "common/transfer/bus/item_client.hpp"
#include "services/mapper/core/updates/map_update.hpp"
#include "services/mapper/reader/live_replica.hpp"
#include "services/mapper/reader/topic_updates.hpp"

namespace rds::mapper {

/// A copy of the live map that is kept up to date, wherever the mapper is: from its topics on the same
/// machine, by transfer from another one, at the pace of the link.
class MapFollower {
 public:
  using Where = transfer::ItemClient::Where;

  /// @param context  of this process; its diagnostics count what was refused. @param host  for tests.
  /// @param listener  called with each change, on threads of this follower.
  explicit MapFollower(service::ServiceContext& context, std::uint64_t host = transfer::this_host(),
                       MapListener listener = {});

  [[nodiscard]] const LiveReplica& map() const { return replica_; }
  /// Where the mapper is (any thread).
  [[nodiscard]] Where where() const { return where_; }

 private:
  void change_over(Where where);
  std::optional<std::uint64_t> next(std::uint64_t map_id, const transfer::Offer& offer);
  void take(std::uint64_t map_id, const transfer::Item& item);
  std::string apply(MapUpdate update);

  service::ServiceContext& context_;
  LiveReplica replica_;
  std::atomic<Where> where_ = Where::kUnknown;
  std::optional<std::uint64_t> asked_since_;  // revision, of an update that has not come
  std::optional<TopicUpdates> near_;          // of the client's thread
  transfer::ItemClient far_;                  // last: its thread uses the others
};

}  // namespace rds::mapper
