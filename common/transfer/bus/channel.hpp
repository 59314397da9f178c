// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "common/bus/participant.hpp"
#include "common/service/peers/peers.hpp"
#include "common/topics/topics.hpp"
#include "common/transfer/transfer.hpp"

namespace rds::transfer {

/// What is transferred from one kind of service: its topics, and how many writers each of them has in turn
/// where messages may overtake each other.
struct Channel {
  topics::Topic<rds_msgs::msg::TransferOffer> offers;
  topics::Topic<rds_msgs::msg::TransferRequest> requests;
  std::string_view writer;  // kind of service
  topics::Process readers;
  std::size_t lanes;
};

/// 32 chunks of 1.2 kB are what 20 Mbit/s carry in 15 ms.
inline constexpr Channel kKeyframes{topics::kTransferOffers, topics::kTransferRequests, service::kTracker,
                                    topics::kFarReaders, 32};
/// Any number of readers, each with a topic of its own for its chunks: fewer writers, as each of them has to
/// be told to everybody.
inline constexpr Channel kMaps{topics::kMapOffers, topics::kMapRequests, service::kMapper, topics::kTool, 8};

inline Way way_of(bus::Vendor vendor) {
  return vendor == bus::Vendor::kZenoh ? Way::kStream : Way::kDatagrams;
}

/// On a stream messages come in the order in which they were written.
inline std::size_t lanes_of(const Channel& channel, bus::Vendor vendor) {
  return way_of(vendor) == Way::kStream ? 1 : channel.lanes;
}

/// Name of the topic that carries the same to readers on the writer's machine.
inline const char* near_topic(Stream stream) {
  if (stream == Stream::kMapUpdates) return topics::kMapFull.name;
  return stream == Stream::kKeyframeImages ? topics::kKeyframeImages.name : topics::kKeyframeFeatures.name;
}

/// Name of the topic on which a reader hears its chunks, and no other reader.
inline std::string chunk_topic(topics::Process reader, std::uint64_t instance) {
  const char* name = topics::transfer_to(reader).name;
  return reader == topics::kTool ? fmt::format("{}/reader_{:016x}", name, instance) : name;
}

}  // namespace rds::transfer
