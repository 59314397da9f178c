// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/transfer/bus/item_server.hpp"
#include "services/mapper/core/updates/dated_voxels.hpp"
#include "services/mapper/core/updates/map_update.hpp"

namespace rds::mapper {

/// The map for readers on other machines: each asks for what it lacks, which is made when it does, as one
/// update with each voxel once, and kept while somebody fetches it. Costs nothing before such a reader is
/// there, and ten seconds after the last one has gone.
///
/// The worker hands deltas over; all else happens on the server's thread. An item's number is its
/// update_number(): a reader asks for what brings it from its revision to one that was offered.
class MapSharing : private transfer::ItemMaker {
 public:
  /// @param host  for tests.
  explicit MapSharing(service::ServiceContext& context, std::uint64_t host = transfer::this_host());

  /// A reader is there and the map is not: the worker is to call start().
  [[nodiscard]] bool wants_map() const { return wants_map_; }
  /// The map as it is; steps that are handed over from now on follow it.
  /// @param make  gives it as a delta from revision 0.
  void start(std::function<MapDelta()> make, std::vector<std::string> labels);
  /// The next step, with its map id.
  void add(const std::shared_ptr<const MapDelta>& delta, const std::vector<std::string>& labels);
  /// Another map begins.
  void begin_map();

 private:
  using Bytes = std::vector<std::uint8_t>;
  /// What the worker has handed over.
  struct Inbox {
    bool is_open = false;  // steps are taken
    bool is_torn = false;  // what came before is of no use any more
    std::function<MapDelta()> whole = {};
    std::vector<std::shared_ptr<const MapDelta>> deltas = {};
    std::size_t voxels = 0;  // of the deltas
    std::vector<std::string> labels = {};
  };
  struct Made {
    Bytes bytes;
    transfer::Time asked{};
  };

  Offers offers(bool has_readers) override;
  const Bytes* find(transfer::Stream stream, std::uint64_t number) override;
  void take_inbox();
  void close();
  [[nodiscard]] std::map<std::uint64_t, Made>::const_iterator longest_unasked() const;
  [[nodiscard]] std::optional<Bytes> make(const UpdateSpan& span) const;

  std::mutex mutex_;
  Inbox inbox_;  // under the mutex
  std::atomic<bool> wants_map_ = false;

  std::optional<DatedVoxels> voxels_;
  std::vector<std::string> labels_;
  std::map<std::uint64_t, Made> made_;  // by number
  service::Diagnostics::Counter& made_count_;
  transfer::ItemServer server_;  // last: its thread uses the members above
};

}  // namespace rds::mapper
