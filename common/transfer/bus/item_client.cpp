// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/bus/item_client.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "common/topics/topics.hpp"
#include "common/transfer/bus/clock.hpp"

namespace rds::transfer {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kMostOffers = 100;
constexpr std::size_t kMostChunks = 8192;  // 10 MB
constexpr Time kHelloPeriod = std::chrono::seconds(1);
constexpr milliseconds kLongestWait{500};
constexpr milliseconds kWaitForRoom{50};
constexpr Time kPatience = std::chrono::seconds(2);
constexpr std::size_t kMostRows = 40;  // in one datagram

}  // namespace

ItemClient::ItemClient(service::ServiceContext& context, topics::Process process, Stream stream, Order order,
                       Callbacks callbacks, std::uint64_t host)
    : context_(context),
      process_(process),
      stream_(stream),
      order_(order),
      callbacks_(std::move(callbacks)),
      host_(host),
      followed_(context.bus, service::kTracker),
      receiver_(order),
      requests_([&context, process] {
        return topics::advertise(context.bus, topics::kTransferRequests, process);
      }),
      offers_(mailbox_, kMostOffers),
      chunks_(mailbox_, kMostChunks) {
  subscriptions_.push_back(topics::subscribe(context.bus, topics::kTransferOffers, process,
                                             [this](Offers offers, const bus::ParticipantId& writer) {
                                               if (owners_.owns(writer, offers->instance()))
                                                 offers_.push(std::move(offers));
                                             }));
  subscriptions_.push_back(topics::subscribe(context.bus, topics::transfer_to(process), process,
                                             [this](Chunks chunk, const bus::ParticipantId& writer) {
                                               if (chunk->reader() == context_.instance &&
                                                   owners_.owns(writer, chunk->instance()))
                                                 chunks_.push(std::move(chunk));
                                             }));
  context.diagnostics.gauge("transfer items lacking", [this] { return lacking_.load(); });
  context.diagnostics.warning("transfer", [this]() -> std::optional<std::string> {
    const std::size_t lacking = lacking_;
    if (lacking == 0 || now() - lacks_nothing_.load() < kBehindAfter) return std::nullopt;
    return fmt::format("behind: {} items of the tracker have not come yet", lacking);
  });
  context.diagnostics.gauge("transfer round trip us", [this] { return round_trip_us_.load(); });
  context.diagnostics.gauge("transfer chunks asked again", [this] { return asked_again_.load(); });
  context.diagnostics.gauge("transfer chunks impossible", [this] { return impossible_.load(); });
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void ItemClient::run(const std::stop_token& stop) {
  started_ = now();
  while (!stop.stop_requested()) {
    const auto due = receiver_.next_due();
    const auto wait = due ? std::chrono::ceil<milliseconds>(*due - now()) : kLongestWait;
    const auto longest = receiver_.lacking() > 0 && !callbacks_.has_room() ? kWaitForRoom : kLongestWait;
    mailbox_.wait_for(stop, std::clamp(wait, milliseconds(0), longest),
                      [this] { return !offers_.locked_empty() || !chunks_.locked_empty(); });
    try {
      step();
    } catch (const std::exception& e) {
      context_.diagnostics.reject(topics::kTransferOffers.name, service::Rejection::kFailed, e.what());
    }
  }
}

void ItemClient::step() {
  while (const auto offers = offers_.try_pop()) take(**offers);
  while (const auto chunk = chunks_.try_pop()) take(**chunk, now());
  if (where_ == Where::kUnknown && now() - started_ > kPatience) be(Where::kHere);
  if (where_ == Where::kElsewhere) ask(now());
}

void ItemClient::take(const rds_msgs::msg::TransferOffer& offers) {
  const std::size_t rows = offers.streams().size();
  if (offers.oldest().size() != rows || offers.newest().size() != rows)
    return context_.diagnostics.reject(topics::kTransferOffers.name, service::Rejection::kInvalid,
                                       "rows of different lengths");
  if (!followed_.accept(offers.instance(), offers.map_epoch() == map_epoch_ && map_epoch_ != 0))
    return context_.diagnostics.reject(topics::kTransferOffers.name, service::Rejection::kForeign,
                                       "another service");
  follow(offers);
  for (std::size_t i = 0; i < rows; ++i)
    if (static_cast<Stream>(offers.streams()[i]) == stream_)
      receiver_.offer({offers.oldest()[i], offers.newest()[i]});
}

void ItemClient::follow(const rds_msgs::msg::TransferOffer& offers) {
  const bool new_map = offers.map_epoch() != map_epoch_ || writer_ == 0;
  writer_ = offers.instance();
  map_epoch_ = offers.map_epoch();
  if (new_map) receiver_ = Receiver(order_);
  be(offers.host() == host_ ? Where::kHere : Where::kElsewhere);
}

void ItemClient::be(Where where) {
  if (std::exchange(where_, where) != where) callbacks_.where(where);
}

void ItemClient::take(const rds_msgs::msg::TransferChunk& chunk, Time now) {
  if (chunk.instance() != writer_ || chunk.map_epoch() != map_epoch_ ||
      static_cast<Stream>(chunk.stream()) != stream_)
    return;
  auto item = receiver_.take({chunk.number(), chunk.item_bytes(), chunk.index(), chunk.data()}, now);
  if (item) callbacks_.item(map_epoch_, std::move(*item));
}

void ItemClient::ask(Time now) {
  const std::vector<Request> due = receiver_.due(now, callbacks_.has_room());
  for (std::size_t i = 0; i < due.size(); i += kMostRows)
    send(std::span(due).subspan(i, std::min(kMostRows, due.size() - i)));
  if (due.empty() && now - last_hello_ >= kHelloPeriod) send({});
  if (now - last_hello_ >= kHelloPeriod) last_hello_ = now;
  lacking_ = receiver_.lacking();
  if (lacking_ == 0) lacks_nothing_ = now;
  asked_again_ = receiver_.statistics().asked_again;
  impossible_ = receiver_.statistics().impossible;
  round_trip_us_ = static_cast<std::uint64_t>(receiver_.window().round_trip() / std::chrono::microseconds(1));
}

void ItemClient::send(std::span<const Request> requests) {
  rds_msgs::msg::TransferRequest message;
  message.instance(context_.instance);
  message.writer(writer_);
  message.map_epoch(map_epoch_);
  message.lacking(static_cast<std::uint32_t>(receiver_.lacking()));
  message.reader(static_cast<std::uint8_t>(process_));
  for (const Request& request : requests) {
    message.streams().push_back(static_cast<std::uint8_t>(stream_));
    message.numbers().push_back(request.number);
    message.firsts().push_back(request.first);
    message.counts().push_back(request.count);
  }
  requests_.write(message);
}

}  // namespace rds::transfer
