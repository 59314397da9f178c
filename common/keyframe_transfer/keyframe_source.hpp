// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "common/keyframe_codec/keyframe_codec.hpp"
#include "common/transfer/bus/item_client.hpp"
#include "rds_msgs/msg/KeyFrameFeatures.h"
#include "rds_msgs/msg/KeyFrameImages.h"

namespace rds::keyframe_transfer {

/// Keyframes that a reader can take beside those that wait, before it asks for further ones.
inline constexpr std::size_t kRoom = transfer::Receiver::kMostBegun;

/// A service's keyframes, wherever the tracker is: from its topic on the same machine, by transfer from
/// another one, so that no raw picture leaves the tracker's machine.
template <class Message>
class KeyframeSource {
 public:
  using Callback = std::function<void(std::shared_ptr<const Message>)>;

  /// @param subscribe  to the topic of the same machine. @param callback  with each keyframe, from whichever;
  /// on a thread of the bus or of the transfer, one after the other. @param has_room  for kRoom more; of any
  /// thread.
  KeyframeSource(service::ServiceContext& context, topics::Process process,
                 std::function<bus::Subscription(Callback)> subscribe, Callback callback,
                 std::function<bool()> has_room);

 private:
  void change_over(transfer::ItemClient::Where where);
  void take(std::uint64_t map_epoch, const transfer::Item& item);

  service::ServiceContext& context_;
  std::function<bus::Subscription(Callback)> subscribe_;
  Callback callback_;
  keyframe_codec::KeyframeDecompressor decompressor_;
  bus::Subscription near_;    // of the client's thread
  transfer::ItemClient far_;  // last: its thread uses the others
};

extern template class KeyframeSource<rds_msgs::msg::KeyFrameImages>;
extern template class KeyframeSource<rds_msgs::msg::KeyFrameFeatures>;

}  // namespace rds::keyframe_transfer
