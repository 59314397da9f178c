// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/bus/item_client.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "common/topics/topics.hpp"

namespace rds::transfer {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kMostOffers = 100;
constexpr std::size_t kMostChunks = 8192;  // 10 MB
constexpr milliseconds kLongestWait{500};
constexpr milliseconds kWaitForRoom{50};
constexpr std::size_t kMostRows = 40;  // in one datagram

}  // namespace

ItemClient::Inboxes::Inboxes() : offers(mailbox, kMostOffers), chunks(mailbox, kMostChunks) {}

ItemClient::ItemClient(service::ServiceContext& context, topics::Process process, const Channel& channel,
                       Stream stream, Order order, Callbacks callbacks, std::uint64_t host)
    : context_(context),
      channel_(channel),
      self_{process, stream, order, host},
      callbacks_(std::move(callbacks)),
      source_{.followed = {context.bus, channel.writer}},
      receiver_(new_receiver()),
      requests_(lanes_of(channel, context.participant.vendor),
                [this, process] { return topics::advertise(context_.bus, channel_.requests, process); }) {
  subscriptions_.push_back(topics::subscribe(context.bus, channel.offers, process,
                                             [this](Offers offers, const bus::ParticipantId& writer) {
                                               if (owners_.owns(writer, offers->instance()))
                                                 inboxes_.offers.push(std::move(offers));
                                             }));
  const std::string topic = chunk_topic(process, context.instance);
  subscriptions_.push_back(topics::subscribe(context.bus, topics::transfer_to(process).named(topic), process,
                                             [this](Chunks chunk, const bus::ParticipantId& writer) {
                                               if (chunk->reader() == context_.instance &&
                                                   owners_.owns(writer, chunk->instance()))
                                                 inboxes_.chunks.push(std::move(chunk));
                                             }));
  tell(context.diagnostics);
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void ItemClient::tell(service::Diagnostics& diagnostics) {
  diagnostics.gauge("transfer items lacking", [this] { return figures_.backlog.items(); });
  diagnostics.gauge("transfer items given up", [this] { return figures_.given_up.items(); });
  diagnostics.gauge("transfer round trip us", [this] { return figures_.round_trip_us.load(); });
  diagnostics.gauge("transfer link kbit_s", [this] { return figures_.link_kbit_s.load(); });
  diagnostics.gauge("transfer chunks asked again", [this] { return figures_.asked_again.load(); });
  diagnostics.gauge("transfer chunks impossible", [this] { return figures_.impossible.load(); });
  diagnostics.warning("transfer", [this]() -> std::optional<std::string> {
    const auto behind = figures_.backlog.behind(now());
    if (!behind) return std::nullopt;
    return fmt::format("behind: {} items of {} have not come in time", *behind,
                       source_.followed.name_of(figures_.followed));
  });
  diagnostics.warning("transfer given up", [this]() -> std::optional<std::string> {
    const auto given_up = figures_.given_up.lately(now());
    if (!given_up) return std::nullopt;
    return fmt::format("{} items of {} cannot be had any more", *given_up,
                       source_.followed.name_of(figures_.followed));
  });
}

Receiver ItemClient::new_receiver() const {
  return Receiver(self_.order, way_of(context_.participant.vendor));
}

void ItemClient::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const auto longest = receiver_.lacking() > 0 && !callbacks_.has_room() ? kWaitForRoom : kLongestWait;
    inboxes_.mailbox.wait_for(stop, std::clamp(until_due(), milliseconds(0), longest), [this] {
      return !inboxes_.offers.locked_empty() || !inboxes_.chunks.locked_empty();
    });
    try {
      step();
    } catch (const std::exception& e) {
      context_.diagnostics.reject(channel_.offers.name, service::Rejection::kFailed, e.what());
    }
  }
}

/// Until there is something to ask for or to tell, if nothing comes.
milliseconds ItemClient::until_due() const {
  const Time time = now();
  Time due = std::min(receiver_.next_due().value_or(Time::max()),
                      receiver_.next_overdue(time).value_or(Time::max()));
  if (!source_.offers.empty()) due = std::min(due, source_.offers.front().due);
  return due == Time::max() ? kLongestWait : std::chrono::ceil<milliseconds>(due - time);
}

void ItemClient::step() {
  while (const auto offers = inboxes_.offers.try_pop()) take(**offers);
  while (const auto chunk = inboxes_.chunks.try_pop()) take(**chunk, now());
  hear_due_offers(now());
  if (source_.where == Where::kUnknown && is_here_without_offer(now())) be(Where::kHere);
  if (source_.where == Where::kElsewhere) ask(now());
}

/// On the loopback interface everything is.
bool ItemClient::is_here_without_offer(Time now) {
  if (context_.participant.loopback_only) return source_.patience.is_over(true, now, Patience::kShort);
  const std::string topic = context_.bus.full_name(near_topic(self_.stream));
  const auto writes = [&topic](const auto& endpoint) {
    return endpoint.publisher && endpoint.topic == topic;
  };
  return source_.patience.is_over(std::ranges::any_of(context_.bus.discovered(), writes), now);
}

void ItemClient::take(const rds_msgs::msg::TransferOffer& offers) {
  const std::size_t rows = offers.streams().size();
  if (offers.oldest().size() != rows || offers.newest().size() != rows || offers.lost().size() != rows)
    return context_.diagnostics.reject(channel_.offers.name, service::Rejection::kInvalid,
                                       "rows of different lengths");
  if (!source_.followed.accept(offers.instance(),
                               offers.map_epoch() == source_.map_epoch && source_.map_epoch != 0))
    return context_.diagnostics.reject(channel_.offers.name, service::Rejection::kForeign, "another service");
  follow(offers);
  TimedOffer heard{now() + callbacks_.gives_way};
  for (std::size_t i = 0; i < rows; ++i)
    if (static_cast<Stream>(offers.streams()[i]) == self_.stream)
      heard.offer = Offer{offers.oldest()[i], offers.newest()[i], offers.lost()[i]};
  source_.offers.push_back(heard);
}

void ItemClient::hear_due_offers(Time now) {
  while (!source_.offers.empty() && source_.offers.front().due <= now) {
    source_.offer = source_.offers.front().offer;
    source_.offers.pop_front();
    want();
  }
}

/// All that is offered, or one item after the other.
void ItemClient::want() {
  if (!source_.offer) return;
  if (!callbacks_.next) return receiver_.offer(*source_.offer, now());
  if (receiver_.lacking() > 0) return;
  const auto next = callbacks_.next(source_.map_epoch, *source_.offer);
  if (!next) return;
  if (*next <= last_wanted_) receiver_ = new_receiver();  // the numbers of one go up
  last_wanted_ = *next;
  receiver_.offer({*next, *next}, now());
}

void ItemClient::follow(const rds_msgs::msg::TransferOffer& offers) {
  const bool new_map = offers.map_epoch() != source_.map_epoch || source_.instance == 0;
  source_.instance = offers.instance();
  source_.map_epoch = offers.map_epoch();
  if (new_map) {
    source_.offers.clear();
    source_.offer.reset();
    receiver_ = new_receiver();
    last_wanted_ = 0;
  }
  be(offers.host() == self_.host ? Where::kHere : Where::kElsewhere);
}

void ItemClient::be(Where where) {
  if (std::exchange(source_.where, where) != where) callbacks_.where(where);
}

void ItemClient::take(const rds_msgs::msg::TransferChunk& chunk, Time now) {
  if (chunk.instance() != source_.instance || chunk.map_epoch() != source_.map_epoch ||
      static_cast<Stream>(chunk.stream()) != self_.stream)
    return;
  const std::uint64_t impossible = receiver_.statistics().impossible;
  auto item = receiver_.take({chunk.number(), chunk.item_bytes(), chunk.index(), chunk.data()}, now);
  if (callbacks_.next && receiver_.statistics().impossible > impossible)
    receiver_ = new_receiver();  // the item was made anew, and is another one
  if (!item) return;
  callbacks_.item(source_.map_epoch, std::move(*item));
  if (callbacks_.next) want();
}

void ItemClient::ask(Time now) {
  const std::vector<Request> due = receiver_.due(now, callbacks_.has_room());
  for (std::size_t i = 0; i < due.size(); i += kMostRows)
    send(std::span(due).subspan(i, std::min(kMostRows, due.size() - i)));
  const std::size_t overdue = receiver_.overdue(now);
  if (hello_.is_due(overdue, now) && due.empty()) send({});
  figures_.backlog.set(overdue, now);
  figures_.given_up.set(receiver_.statistics().given_up, now);
  figures_.followed = source_.instance;
  figures_.asked_again = receiver_.statistics().asked_again;
  figures_.impossible = receiver_.statistics().impossible;
  figures_.round_trip_us = round_trip_us();
  figures_.link_kbit_s = link_kbit_s();
}

std::uint64_t ItemClient::round_trip_us() const {
  return static_cast<std::uint64_t>(receiver_.window().round_trip() / std::chrono::microseconds(1));
}

std::uint64_t ItemClient::link_kbit_s() const {
  return static_cast<std::uint64_t>(receiver_.window().bits_per_s() / 1e3);
}

void ItemClient::send(std::span<const Request> requests) {
  rds_msgs::msg::TransferRequest message;
  message.instance(context_.instance);
  message.writer(source_.instance);
  message.map_epoch(source_.map_epoch);
  message.lacking(static_cast<std::uint32_t>(receiver_.overdue(now())));
  message.arrived(receiver_.statistics().items);
  message.given_up(receiver_.statistics().given_up);
  message.round_trip_us(static_cast<std::uint32_t>(round_trip_us()));
  message.link_kbit_s(static_cast<std::uint32_t>(link_kbit_s()));
  message.reader(static_cast<std::uint8_t>(self_.process));
  for (const Request& request : requests) {
    message.streams().push_back(static_cast<std::uint8_t>(self_.stream));
    message.numbers().push_back(request.number);
    message.firsts().push_back(request.first);
    message.counts().push_back(request.count);
  }
  requests_.write(message);
}

}  // namespace rds::transfer
