// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/bus/item_server.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "common/concurrency/priority.hpp"
#include "common/topics/topics.hpp"
#include "common/transfer/bus/clock.hpp"

namespace rds::transfer {
namespace {

// Each holds a keyframe's pictures until they are compressed.
constexpr std::size_t kMostWaiting = 8;
constexpr std::size_t kMostRequests = 256;
/// Of one request; a reader's window is smaller.
constexpr std::uint32_t kMostChunks = 4096;
constexpr int kNice = 10;  // tracking has the processor first
constexpr std::chrono::seconds kOfferPeriod{1};

}  // namespace

ItemServer::ItemServer(service::ServiceContext& context, topics::Process process, std::size_t memory_bytes,
                       std::uint64_t host)
    : context_(context),
      memory_bytes_(memory_bytes),
      host_(host),
      offers_(topics::advertise(context.bus, topics::kTransferOffers, process)),
      shared_(mailbox_, kMostWaiting),
      requests_(mailbox_, kMostRequests) {
  for (const topics::Process reader : {topics::kDetector, topics::kMapper, topics::kLoopCloser})
    add_reader(reader, process);
  subscription_ =
      topics::subscribe(context.bus, topics::kTransferRequests, process, [this](const Request& request) {
        if (request->writer() == context_.instance) requests_.push(request);
      });
  context.diagnostics.gauge("transfer items not made", [this] { return shared_.dropped(); });
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void ItemServer::add_reader(topics::Process process, topics::Process own) {
  const auto& topic = topics::transfer_to(process);
  Reader& reader =
      readers_
          .try_emplace(process, [this, &topic, own] { return topics::advertise(context_.bus, topic, own); })
          .first->second;
  context_.diagnostics.warning(topic.name, [&reader, &topic]() -> std::optional<std::string> {
    const std::uint32_t lacking = reader.lacking;
    if (lacking == 0 || now() - reader.lacks_nothing.load() < kBehindAfter) return std::nullopt;
    return fmt::format("{}: the reader is behind by {} items", topic.name, lacking);
  });
}

void ItemServer::share(std::uint64_t map_epoch, Stream stream, std::uint64_t number,
                       std::function<Bytes()> make) {
  if (has_readers_) shared_.push({map_epoch, {stream, number}, std::move(make)});
}

void ItemServer::run(const std::stop_token& stop) {
  concurrency::give_way(kNice);
  while (!stop.stop_requested()) {
    const bool woken = mailbox_.wait_for(
        stop, kOfferPeriod, [this] { return !shared_.locked_empty() || !requests_.locked_empty(); });
    while (const auto request = requests_.try_pop()) answer(**request);
    if (const auto shared = shared_.try_pop()) take(*shared);
    if (!woken) offer();
  }
}

void ItemServer::take(const Shared& shared) {
  if (shared.map_epoch != map_epoch_) {
    items_.clear();
    bytes_ = 0;
    map_epoch_ = shared.map_epoch;
  }
  try {
    if (shared.make) keep(shared.id, shared.make());
  } catch (const std::exception& e) {
    context_.diagnostics.reject(topics::kTransferOffers.name, service::Rejection::kFailed, e.what());
  }
  offer();
}

void ItemServer::keep(const Id& id, Bytes item) {
  if (item.empty() || item.size() > kMaxItemBytes) return;
  Bytes& kept = items_[id];
  bytes_ += item.size() - kept.size();
  kept = std::move(item);
  while (bytes_ > memory_bytes_ && items_.size() > 1) forget_most();
}

/// The oldest item of the stream that takes most memory.
void ItemServer::forget_most() {
  std::map<Stream, std::size_t> sizes;
  for (const auto& [id, item] : items_) sizes[id.first] += item.size();
  const auto most = std::ranges::max_element(sizes, {}, [](const auto& entry) { return entry.second; });
  const auto oldest = items_.lower_bound({most->first, 0});
  bytes_ -= oldest->second.size();
  items_.erase(oldest);
}

void ItemServer::offer() {
  rds_msgs::msg::TransferOffer offer;
  offer.instance(context_.instance);
  offer.host(host_);
  offer.map_epoch(map_epoch_);
  for (auto it = items_.begin(); it != items_.end();) {
    const Stream stream = it->first.first;
    const auto end = std::find_if(it, items_.end(), [&](const auto& e) { return e.first.first != stream; });
    offer.streams().push_back(static_cast<std::uint8_t>(stream));
    offer.oldest().push_back(it->first.second);
    offer.newest().push_back(std::prev(end)->first.second);
    it = end;
  }
  offers_.write(offer);
}

void ItemServer::answer(const rds_msgs::msg::TransferRequest& request) {
  has_readers_ = true;
  const auto to = readers_.find(static_cast<topics::Process>(request.reader()));
  const std::size_t rows = request.streams().size();
  if (to == readers_.end() || request.map_epoch() != map_epoch_ || request.numbers().size() != rows ||
      request.firsts().size() != rows || request.counts().size() != rows)
    return;
  to->second.lacking = request.lacking();
  if (request.lacking() == 0) to->second.lacks_nothing = now();
  for (std::size_t i = 0; i < rows; ++i) {
    const auto stream = static_cast<Stream>(request.streams()[i]);
    const std::uint64_t number = request.numbers()[i];
    const std::uint64_t first = request.firsts()[i];
    const auto item = items_.find({stream, number});
    if (item == items_.end()) {
      send({number, 0, request.firsts()[i], {}}, stream, request.instance(), to->second.chunks);
      continue;
    }
    const std::uint64_t end = std::min<std::uint64_t>(first + std::min(request.counts()[i], kMostChunks),
                                                      chunks_in(item->second.size()));
    for (std::uint64_t k = first; k < end; ++k)
      send(chunk_of(number, item->second, static_cast<std::uint32_t>(k)), stream, request.instance(),
           to->second.chunks);
  }
}

void ItemServer::send(const Chunk& chunk, Stream stream, std::uint64_t reader,
                      Lanes<rds_msgs::msg::TransferChunk>& to) {
  rds_msgs::msg::TransferChunk message;
  message.instance(context_.instance);
  message.reader(reader);
  message.map_epoch(map_epoch_);
  message.stream(static_cast<std::uint8_t>(stream));
  message.number(chunk.number);
  message.item_bytes(chunk.item_bytes);
  message.index(chunk.index);
  message.data().assign(chunk.data.begin(), chunk.data.end());
  to.write(message);
}

}  // namespace rds::transfer
