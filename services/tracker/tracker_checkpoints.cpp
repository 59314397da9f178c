// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_checkpoints.hpp"

#include "common/map_file/byte_reader.hpp"

namespace rds::tracker {
namespace {

constexpr const char* kEpoch = "epoch";
constexpr std::size_t kMaxWaitingBytes = 64'000'000;  // while the disk is full

store::Bytes to_bytes(const TrackerCheckpoints::Epoch& epoch) {
  map_file::ByteWriter writer;
  writer.put(epoch.map_epoch);
  writer.put(epoch.start);
  writer.put(epoch.loops.instance);
  writer.put(epoch.loops.revision);
  writer.put(epoch.loops.loops_closed);
  return writer.take();
}

tl::expected<TrackerCheckpoints::Epoch, std::string> epoch_from(std::span<const std::uint8_t> bytes) {
  map_file::ByteReader reader(bytes);
  TrackerCheckpoints::Epoch epoch;
  epoch.map_epoch = reader.get<std::uint64_t>();
  epoch.start = reader.get<std::uint64_t>();
  epoch.loops.instance = reader.get<std::uint64_t>();
  epoch.loops.revision = reader.get<std::uint64_t>();
  epoch.loops.loops_closed = reader.get<std::uint32_t>();
  if (const auto whole = reader.finish(); !whole) return tl::unexpected(whole.error());
  return epoch;
}

}  // namespace

tl::expected<std::optional<TrackerCheckpoints::Epoch>, std::string> TrackerCheckpoints::restore(
    std::uint64_t start, Tracker& tracker) {
  const auto row = writer_ ? writer_->get(kEpoch, 0) : std::nullopt;
  if (!row) return std::nullopt;
  const auto epoch = epoch_from(*row);
  if (!epoch) return tl::unexpected(epoch.error());
  if (epoch->start != start) return tl::unexpected(std::string("it began with another saved map"));
  const auto resumed = tracker.resume(
      [this](const std::string& kind, const VisitRow& visit) { return writer_->for_each(kind, visit); });
  if (!resumed) return tl::unexpected(resumed.error());
  if (tracker.map().keyframes().size() == 0) return std::nullopt;
  return *epoch;
}

void TrackerCheckpoints::save(Tracker& tracker, const Epoch& epoch) {
  if (!writer_) return;
  schedule_.restart();
  if (changes_.bytes() < kMaxWaitingBytes) {
    for (CheckpointRow& row : tracker.checkpoint()) {
      if (row.bytes)
        changes_.put(std::move(row.kind), row.id, std::move(*row.bytes));
      else
        changes_.erase(std::move(row.kind), row.id);
    }
    changes_.put(kEpoch, 0, to_bytes(epoch));
  }
  (void)writer_->write(changes_);  // where too much waits these wait here for the next time
}

void TrackerCheckpoints::clear() {
  if (!writer_) return;
  writer_->keep_previous();
  changes_.clear();
}

}  // namespace rds::tracker
