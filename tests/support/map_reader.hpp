// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "services/mapper/reader/topic_updates.hpp"

namespace rds::test {

/// A copy of the map from its topics, on whichever machine the mapper is. Safe to use from any thread.
class MapReader {
 public:
  explicit MapReader(bus::Participant& bus) : context_{"map_reader", bus, diagnostics_} {}

  /// The copy as mapper::to_bytes() gives it; empty without one.
  [[nodiscard]] std::vector<std::uint8_t> bytes() const;
  [[nodiscard]] std::uint64_t revision() const { return replica_.place().revision; }
  [[nodiscard]] std::uint64_t map_id() const { return replica_.place().map_id; }
  /// Labelled voxels.
  [[nodiscard]] std::size_t labelled() const;

 private:
  service::Diagnostics diagnostics_;
  service::ServiceContext context_;
  mapper::LiveReplica replica_;
  mapper::TopicUpdates updates_{context_, replica_};
};

}  // namespace rds::test
