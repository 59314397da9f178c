// SPDX-License-Identifier: Apache-2.0
#include "common/keyframe_transfer/keyframe_source.hpp"

#include <spdlog/spdlog.h>

#include "common/keyframe_transfer/item_bytes.hpp"

namespace rds::keyframe_transfer {
namespace {

using rds_msgs::msg::KeyFrameCompressed;
using rds_msgs::msg::KeyFrameFeatures;
using rds_msgs::msg::KeyFrameImages;
using Where = transfer::ItemClient::Where;

transfer::Stream stream_of(const KeyFrameImages* /*type*/) {
  return transfer::Stream::kKeyframeImages;
}
transfer::Stream stream_of(const KeyFrameFeatures* /*type*/) {
  return transfer::Stream::kKeyframeFeatures;
}

template <class Message>
using Decoded = tl::expected<std::shared_ptr<const Message>, std::string>;

Decoded<KeyFrameFeatures> decode(const transfer::Item& item, keyframe_codec::KeyframeDecompressor& /*d*/,
                                 const KeyFrameFeatures* /*type*/) {
  auto features = message_of<KeyFrameFeatures>(item.bytes);
  if (features == nullptr) return tl::unexpected(std::string("no features of a keyframe"));
  return features;
}

Decoded<KeyFrameImages> decode(const transfer::Item& item, keyframe_codec::KeyframeDecompressor& decompressor,
                               const KeyFrameImages* /*type*/) {
  const auto compressed = message_of<KeyFrameCompressed>(item.bytes);
  if (compressed == nullptr) return tl::unexpected(std::string("no compressed keyframe"));
  auto images = decompressor.decompress(*compressed);
  if (!images) return tl::unexpected(images.error());
  return std::make_shared<const KeyFrameImages>(std::move(*images));
}

}  // namespace

template <class Message>
KeyframeSource<Message>::KeyframeSource(service::ServiceContext& context, topics::Process process,
                                        std::function<bus::Subscription(Callback)> subscribe,
                                        Callback callback)
    : context_(context),
      subscribe_(std::move(subscribe)),
      callback_(std::move(callback)),
      far_(context, process, {stream_of(static_cast<Message*>(nullptr))},
           {.item = [this](std::uint64_t epoch, const transfer::Item& item) { take(epoch, item); },
            .where = [this](Where where) { change_over(where); }}) {}

template <class Message>
void KeyframeSource<Message>::change_over(Where where) {
  near_.reset();
  if (where == Where::kHere) near_ = std::make_unique<bus::Subscription>(subscribe_(callback_));
  if (where == Where::kElsewhere)
    spdlog::info("the tracker is on another machine: keyframes are transferred");
}

/// What an item says of itself has to be what it was asked for as.
template <class Message>
void KeyframeSource<Message>::take(std::uint64_t map_epoch, const transfer::Item& item) {
  const auto message = decode(item, decompressor_, static_cast<Message*>(nullptr));
  if (message && (*message)->map_epoch() == map_epoch && (*message)->keyframe_id() == item.id.number)
    return callback_(*message);
  context_.diagnostics.reject(topics::kTransferOffers.name, service::Rejection::kInvalid,
                              message ? "another keyframe than the one asked for" : message.error());
}

template class KeyframeSource<KeyFrameImages>;
template class KeyframeSource<KeyFrameFeatures>;

}  // namespace rds::keyframe_transfer
