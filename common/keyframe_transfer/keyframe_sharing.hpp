// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/keyframe_codec/keyframe_codec.hpp"
#include "common/transfer/bus/item_server.hpp"
#include "rds_msgs/msg/KeyFrameFeatures.h"
#include "rds_msgs/msg/KeyFrameImages.h"

namespace rds::keyframe_transfer {

/// A tracker's keyframes for readers on other machines, those too that come later: compressed, and kept while
/// there is room, on a thread of its own. Costs nothing on the loopback interface.
class KeyframeSharing {
 public:
  KeyframeSharing(service::ServiceContext& context, std::uint64_t map_epoch);

  /// Another map: what was shared before is forgotten.
  void begin(std::uint64_t map_epoch) { server_.begin(map_epoch); }
  void share(rds_msgs::msg::KeyFrameImages&& images);
  void share(rds_msgs::msg::KeyFrameFeatures&& features);

 private:
  std::shared_ptr<keyframe_codec::KeyframeCompressor> compressor_;  // of the server's thread
  transfer::ItemServer server_;
};

}  // namespace rds::keyframe_transfer
