// SPDX-License-Identifier: Apache-2.0
#include "common/keyframe_transfer/keyframe_sharing.hpp"

#include <stdexcept>

#include "common/keyframe_transfer/item_bytes.hpp"

namespace rds::keyframe_transfer {
namespace {

using transfer::Stream;

/// Half a minute of five keyframes a second, and what is older, some 40 minutes of keyframes among people:
/// what a machine misses that is away for so long, and what one begins with that is started later.
constexpr transfer::ItemServer::Room kKeyframeRoom{.memory_bytes = std::size_t{32} << 20U,
                                                   .file_bytes = std::size_t{2} << 30U};

}  // namespace

KeyframeSharing::KeyframeSharing(service::ServiceContext& context, std::uint64_t map_epoch)
    : compressor_(std::make_shared<keyframe_codec::KeyframeCompressor>()),
      server_(context, topics::kTracker, transfer::kKeyframes, kKeyframeRoom) {
  begin(map_epoch);
}

void KeyframeSharing::share(rds_msgs::msg::KeyFrameImages&& images) {
  const auto held = std::make_shared<const rds_msgs::msg::KeyFrameImages>(std::move(images));
  server_.share(held->map_epoch(), Stream::kKeyframeImages, held->keyframe_id(),
                [held, compressor = compressor_] {
                  const auto compressed = compressor->compress(*held);
                  if (!compressed) throw std::runtime_error(compressed.error());
                  return bytes_of(*compressed);
                });
}

void KeyframeSharing::share(rds_msgs::msg::KeyFrameFeatures&& features) {
  const auto held = std::make_shared<const rds_msgs::msg::KeyFrameFeatures>(std::move(features));
  server_.share(held->map_epoch(), Stream::kKeyframeFeatures, held->keyframe_id(),
                [held] { return bytes_of(*held); });
}

}  // namespace rds::keyframe_transfer
