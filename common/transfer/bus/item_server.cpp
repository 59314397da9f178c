// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/bus/item_server.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "common/concurrency/priority.hpp"
#include "common/topics/topics.hpp"
#include "common/transfer/bus/item_file.hpp"

namespace rds::transfer {
namespace {

// Each holds a keyframe's pictures until they are compressed.
constexpr std::size_t kMostWaiting = 8;
constexpr std::size_t kMostRequests = 256;
constexpr std::size_t kMostSpilledBytes = std::size_t{2} << 30U;  // of keyframes among people about 40 minutes
/// Of one request; a reader's window is smaller.
constexpr std::uint32_t kMostChunks = 4096;
constexpr int kNice = 10;  // tracking has the processor first
constexpr std::chrono::seconds kOfferPeriod{1};

}  // namespace

ItemServer::ItemServer(service::ServiceContext& context, topics::Process process, std::size_t memory_bytes,
                       std::uint64_t host)
    : context_(context),
      host_(host),
      items_(memory_bytes, std::make_unique<ItemFile>(), kMostSpilledBytes),
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
    const auto behind = reader.backlog.behind(now());
    if (!behind) return std::nullopt;
    return fmt::format("{}: the reader is behind by {} items", topic.name, *behind);
  });
}

void ItemServer::share(std::uint64_t map_epoch, Stream stream, std::uint64_t number,
                       std::function<Bytes()> make) {
  if (has_readers_) shared_.push({map_epoch, stream, number, std::move(make)});
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
  if (std::exchange(map_epoch_, shared.map_epoch) != shared.map_epoch) items_.clear();
  try {
    if (shared.make) items_.put(shared.stream, shared.number, shared.make());
  } catch (const std::exception& e) {
    context_.diagnostics.reject(topics::kTransferOffers.name, service::Rejection::kFailed, e.what());
  }
  offer();
}

void ItemServer::offer() {
  rds_msgs::msg::TransferOffer offer;
  offer.instance(context_.instance);
  offer.host(host_);
  offer.map_epoch(map_epoch_);
  for (const auto& [stream, range] : items_.offers()) {
    offer.streams().push_back(static_cast<std::uint8_t>(stream));
    offer.oldest().push_back(range.oldest);
    offer.newest().push_back(range.newest);
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
  to->second.backlog.set(request.lacking(), now());
  for (std::size_t i = 0; i < rows; ++i) {
    const auto stream = static_cast<Stream>(request.streams()[i]);
    const std::uint64_t number = request.numbers()[i];
    const std::uint64_t first = request.firsts()[i];
    const Bytes* item = items_.find(stream, number);
    if (item == nullptr) {
      send({number, 0, request.firsts()[i], {}}, stream, request.instance(), to->second.chunks);
      continue;
    }
    const std::uint64_t end =
        std::min<std::uint64_t>(first + std::min(request.counts()[i], kMostChunks), chunks_in(item->size()));
    for (std::uint64_t k = first; k < end; ++k)
      send(chunk_of(number, *item, static_cast<std::uint32_t>(k)), stream, request.instance(),
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
