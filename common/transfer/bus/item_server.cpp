// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/bus/item_server.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "common/concurrency/priority.hpp"
#include "common/topics/topics.hpp"
#include "common/transfer/bus/item_file.hpp"

namespace rds::transfer {
namespace {

/// Every second one holds a keyframe's pictures until they are compressed, 25 MB together.
constexpr std::size_t kMostWaiting = 32;
constexpr std::size_t kMostTold = 1024;  // with those that are lost because so many wait
constexpr std::size_t kMostRequests = 256;
/// Of one request; a reader's window is smaller.
constexpr std::uint32_t kMostChunks = 4096;
constexpr int kNice = 10;  // tracking has the processor first
constexpr std::chrono::milliseconds kOfferPeriod{1000};
constexpr std::chrono::milliseconds kMakingPeriod{250};  // of what is made for readers that are there
constexpr std::size_t kMostReaders = 32;
constexpr std::array kServices{topics::kDetector, topics::kMapper, topics::kLoopCloser};

/// Name before figures of what is shared, and of a service that reads it.
std::string figures_of(Stream stream) {
  return stream == Stream::kKeyframeImages ? topics::kKeyframeImages.name : topics::kKeyframeFeatures.name;
}
std::string figures_of(topics::Process reader) {
  const auto stream = reader == topics::kLoopCloser ? Stream::kKeyframeFeatures : Stream::kKeyframeImages;
  const std::string to = topics::transfer_to(reader).name;
  return figures_of(stream) + to.substr(to.rfind('/'));
}

}  // namespace

ItemServer::ItemServer(service::ServiceContext& context, topics::Process process, const Channel& channel,
                       const Room& room, std::uint64_t host)
    : ItemServer(context, process, channel, room, nullptr, host) {}

ItemServer::ItemServer(service::ServiceContext& context, topics::Process process, const Channel& channel,
                       ItemMaker& maker, std::uint64_t host)
    : ItemServer(context, process, channel, Room{}, &maker, host) {}

ItemServer::ItemServer(service::ServiceContext& context, topics::Process process, const Channel& channel,
                       const Room& room, ItemMaker* maker, std::uint64_t host)
    : context_(context),
      process_(process),
      channel_(channel),
      maker_(maker),
      host_(host),
      items_(room.memory_bytes, std::make_unique<ItemFile>(), room.file_bytes),
      peers_(context.bus),
      offers_(topics::advertise(context.bus, channel.offers, process)),
      chunks_sent_(context.diagnostics.counter("transfer chunks sent")),
      chunks_sent_again_(context.diagnostics.counter("transfer chunks sent again")),
      shared_(mailbox_, kMostTold),
      requests_(mailbox_, kMostRequests) {
  for (const topics::Process reader : kServices)
    if (contains(channel.readers, reader)) warn_of(reader);
  subscription_ = topics::subscribe(context.bus, channel.requests, process, [this](const Request& request) {
    if (request->writer() == context_.instance) requests_.push(request);
  });
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

FarReader& ItemServer::add_reader(topics::Process process, const std::string& topic) {
  const auto advertise = [this, process, topic] {
    return topics::advertise(context_.bus, topics::transfer_to(process).named(topic), process_);
  };
  return readers_.try_emplace(topic, lanes_of(channel_, context_.participant.vendor), advertise)
      .first->second;
}

/// A service that is behind, or lacks something for ever, is told of; how far a reader of the map is behind
/// is its own affair.
void ItemServer::warn_of(topics::Process process) {
  const std::string topic = chunk_topic(process, 0);
  const FarReader& reader = add_reader(process, topic);
  context_.diagnostics.warning(topic, [this, &reader, topic]() -> std::optional<std::string> {
    const auto behind = reader.backlog().behind(now());
    if (!behind) return std::nullopt;
    return fmt::format("{} is behind: {} items have not come in time",
                       peers_.name_of(reader.instance()).value_or(topic), *behind);
  });
  context_.diagnostics.warning(topic + " given up", [this, &reader, topic]() -> std::optional<std::string> {
    const auto given_up = reader.given_up().lately(now());
    if (!given_up) return std::nullopt;
    return fmt::format("{} lacks {} items that cannot be had any more",
                       peers_.name_of(reader.instance()).value_or(topic), *given_up);
  });
}

/// nullptr for one that has no place here.
FarReader* ItemServer::reader_of(const rds_msgs::msg::TransferRequest& request) {
  const auto process = static_cast<topics::Process>(request.reader());
  const bool is_tool = process == topics::kTool && contains(channel_.readers, process);
  if (!is_tool && std::ranges::find(kServices, process) == kServices.end()) return nullptr;
  const std::string topic = chunk_topic(process, request.instance());
  if (const auto known = readers_.find(topic); known != readers_.end()) {
    if (!is_tool) known->second.show(context_.diagnostics, figures_of(process));
    return &known->second;
  }
  if (!is_tool) return nullptr;
  if (readers_.size() >= kMostReaders) {
    context_.diagnostics.reject(channel_.requests.name, service::Rejection::kUnexpected, "too many readers");
    return nullptr;
  }
  FarReader& reader = add_reader(process, topic);
  reader.open();
  return &reader;
}

void ItemServer::forget_silent() {
  if (!contains(channel_.readers, topics::kTool)) return;
  std::erase_if(readers_, [](const auto& entry) { return now() - entry.second.heard() > kSilent; });
}

void ItemServer::share(std::uint64_t map_epoch, Stream stream, std::uint64_t number,
                       std::function<Bytes()> make) {
  if (context_.participant.loopback_only) return;
  if (shared_.size() >= kMostWaiting) make = [] { return Bytes(); };
  shared_.push({map_epoch, stream, number, std::move(make)});
}

void ItemServer::run(const std::stop_token& stop) {
  concurrency::give_way(kNice);
  while (!stop.stop_requested()) {
    const auto wait = maker_ != nullptr && was_asked() ? kMakingPeriod : kOfferPeriod;
    mailbox_.wait_for(stop, wait, [this] { return !shared_.locked_empty() || !requests_.locked_empty(); });
    try {
      while (const auto request = requests_.try_pop()) answer(**request);
      if (const auto shared = shared_.try_pop()) take(*shared);
      if (now() - looked_ >= wait) look();
    } catch (const std::exception& e) {
      context_.diagnostics.reject(channel_.offers.name, service::Rejection::kFailed, e.what());
    }
  }
}

void ItemServer::take(const Shared& shared) {
  if (std::exchange(map_epoch_, shared.map_epoch) != shared.map_epoch) items_.clear();
  looked_ = {};
  if (!shared.make) return;
  ++context_.diagnostics.counter(figures_of(shared.stream) + "/items shared");
  items_.put(shared.stream, shared.number, made(shared));
  context_.diagnostics.counter(figures_of(shared.stream) + "/items lost") = items_.lost(shared.stream);
}

/// Empty if it cannot be.
ItemServer::Bytes ItemServer::made(const Shared& shared) {
  try {
    return shared.make();
  } catch (const std::exception& e) {
    context_.diagnostics.reject(channel_.offers.name, service::Rejection::kFailed, e.what());
    return {};
  }
}

/// Offers what is there, if that has changed or was not said for a while.
void ItemServer::look() {
  looked_ = now();
  forget_silent();
  ItemMaker::Offers offers{map_epoch_, items_.offers()};
  if (maker_ != nullptr) offers = maker_->offers(was_asked());
  map_epoch_ = offers.map_epoch;
  if (offers == offered_ && now() - offered_at_ < kOfferPeriod) return;
  offered_ = offers;
  offered_at_ = now();
  write(offers);
}

void ItemServer::write(const ItemMaker::Offers& offers) {
  rds_msgs::msg::TransferOffer offer;
  offer.instance(context_.instance);
  offer.host(host_);
  offer.map_epoch(offers.map_epoch);
  for (const auto& [stream, range] : offers.streams) {
    offer.streams().push_back(static_cast<std::uint8_t>(stream));
    offer.oldest().push_back(range.oldest);
    offer.newest().push_back(range.newest);
    offer.lost().push_back(range.lost);
  }
  offers_.write(offer);
}

void ItemServer::answer(const rds_msgs::msg::TransferRequest& request) {
  FarReader* to = reader_of(request);
  if (to == nullptr) return;
  asked_ = now();
  to->hear(request, asked_);
  const std::size_t rows = request.streams().size();
  if (request.map_epoch() != map_epoch_ || request.numbers().size() != rows ||
      request.firsts().size() != rows || request.counts().size() != rows)
    return;
  to->hear_of_items(request, asked_);
  for (std::size_t i = 0; i < rows; ++i) {
    const auto stream = static_cast<Stream>(request.streams()[i]);
    const std::uint64_t number = request.numbers()[i];
    const std::uint64_t first = request.firsts()[i];
    const Bytes* item = find(stream, number);
    if (item == nullptr) {
      const std::uint32_t why = items_.is_lost(stream, number) ? kLost : kAbsent;
      send({number, why, request.firsts()[i], {}}, stream, request.instance(), *to);
      continue;
    }
    const std::uint64_t end =
        std::min<std::uint64_t>(first + std::min(request.counts()[i], kMostChunks), chunks_in(item->size()));
    for (std::uint64_t k = first; k < end; ++k)
      send(chunk_of(number, *item, static_cast<std::uint32_t>(k)), stream, request.instance(), *to);
  }
}

const ItemServer::Bytes* ItemServer::find(Stream stream, std::uint64_t number) {
  return maker_ != nullptr ? maker_->find(stream, number) : items_.find(stream, number);
}

void ItemServer::send(const Chunk& chunk, Stream stream, std::uint64_t reader, FarReader& to) {
  rds_msgs::msg::TransferChunk message;
  message.instance(context_.instance);
  message.reader(reader);
  message.map_epoch(map_epoch_);
  message.stream(static_cast<std::uint8_t>(stream));
  message.number(chunk.number);
  message.item_bytes(chunk.item_bytes);
  message.index(chunk.index);
  message.data().assign(chunk.data.begin(), chunk.data.end());
  ++chunks_sent_;
  if (to.send(message)) ++chunks_sent_again_;
}

}  // namespace rds::transfer
