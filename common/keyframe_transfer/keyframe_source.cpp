// SPDX-License-Identifier: Apache-2.0
#include "common/keyframe_transfer/keyframe_source.hpp"

#include <type_traits>

#include <spdlog/spdlog.h>

#include "common/keyframe_transfer/item_bytes.hpp"

namespace rds::keyframe_transfer {
namespace {

using rds_msgs::msg::KeyFrameCompressed;
using rds_msgs::msg::KeyFrameFeatures;
using rds_msgs::msg::KeyFrameImages;
using Where = transfer::ItemClient::Where;

/// The detector has the link for itself first: what the others make of a keyframe waits for its boxes.
constexpr transfer::Time kHeadStart = std::chrono::milliseconds(60);

template <class Message>
constexpr bool kIsImages = std::is_same_v<Message, KeyFrameImages>;

template <class Message>
using Decoded = tl::expected<std::shared_ptr<const Message>, std::string>;

template <class Message>
Decoded<Message> decode(const transfer::Item& item, keyframe_codec::KeyframeDecompressor& decompressor) {
  using OnTheWire = std::conditional_t<kIsImages<Message>, KeyFrameCompressed, Message>;
  const auto message = message_of<OnTheWire>(item.bytes);
  if (message == nullptr) return tl::unexpected(std::string("an item that is no keyframe"));
  if constexpr (kIsImages<Message>) {
    auto images = decompressor.decompress(*message);
    if (!images) return tl::unexpected(images.error());
    return std::make_shared<const Message>(std::move(*images));
  } else {
    return message;
  }
}

}  // namespace

/// A loop closer takes keyframes only in their order; for all others the newest counts.
template <class Message>
KeyframeSource<Message>::KeyframeSource(service::ServiceContext& context, topics::Process process,
                                        std::function<bus::Subscription(Callback)> subscribe,
                                        Callback callback, std::function<bool()> has_room)
    : context_(context),
      subscribe_(std::move(subscribe)),
      callback_(std::move(callback)),
      far_(context, process, transfer::kKeyframes,
           kIsImages<Message> ? transfer::Stream::kKeyframeImages : transfer::Stream::kKeyframeFeatures,
           kIsImages<Message> ? transfer::Order::kNewest : transfer::Order::kNumber,
           {.item = [this](std::uint64_t epoch, const transfer::Item& item) { take(epoch, item); },
            .where = [this](Where where) { change_over(where); },
            .has_room = std::move(has_room),
            .gives_way = process == topics::kDetector ? transfer::Time{} : kHeadStart}) {}

template <class Message>
void KeyframeSource<Message>::change_over(Where where) {
  near_ = where == Where::kHere ? subscribe_(callback_) : bus::Subscription();
  if (where == Where::kElsewhere)
    spdlog::info("the tracker is on another machine: keyframes are transferred");
}

/// What an item says of itself has to be what it was asked for as.
template <class Message>
void KeyframeSource<Message>::take(std::uint64_t map_epoch, const transfer::Item& item) {
  const auto message = decode<Message>(item, decompressor_);
  if (message && (*message)->map_epoch() == map_epoch && (*message)->keyframe_id() == item.number)
    return callback_(*message);
  context_.diagnostics.reject(topics::kTransferOffers.name, service::Rejection::kInvalid,
                              message ? "another keyframe than the one asked for" : message.error());
}

template class KeyframeSource<KeyFrameImages>;
template class KeyframeSource<KeyFrameFeatures>;

}  // namespace rds::keyframe_transfer
