// SPDX-License-Identifier: Apache-2.0
#include "common/keyframe_transfer/keyframe_sharing.hpp"

#include <stdexcept>

#include "common/keyframe_transfer/item_bytes.hpp"

namespace rds::keyframe_transfer {
namespace {

using transfer::Stream;

/// A minute and a half of five keyframes a second: what a machine misses that is away for so long, and what
/// one that was started again begins with.
constexpr std::size_t kMemoryBytes = std::size_t{100} << 20U;

}  // namespace

KeyframeSharing::KeyframeSharing(service::ServiceContext& context)
    : compressor_(std::make_shared<keyframe_codec::KeyframeCompressor>()),
      server_(context, topics::kTracker, kMemoryBytes) {}

void KeyframeSharing::share(rds_msgs::msg::KeyFrameImages&& images) {
  const std::uint64_t epoch = images.map_epoch();
  const transfer::ItemId id{Stream::kKeyframeImages, images.keyframe_id()};
  if (!server_.has_readers()) return;
  const auto held = std::make_shared<const rds_msgs::msg::KeyFrameImages>(std::move(images));
  server_.share(epoch, id, [held, compressor = compressor_] {
    const auto compressed = compressor->compress(*held);
    if (!compressed) throw std::runtime_error(compressed.error());
    return bytes_of(*compressed);
  });
}

void KeyframeSharing::share(rds_msgs::msg::KeyFrameFeatures&& features) {
  const std::uint64_t epoch = features.map_epoch();
  const transfer::ItemId id{Stream::kKeyframeFeatures, features.keyframe_id()};
  if (!server_.has_readers()) return;
  const auto held = std::make_shared<const rds_msgs::msg::KeyFrameFeatures>(std::move(features));
  server_.share(epoch, id, [held] { return bytes_of(*held); });
}

}  // namespace rds::keyframe_transfer
