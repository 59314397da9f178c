// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/bus/far_reader.hpp"

namespace rds::transfer {

FarReader::Figures::Figures(service::Diagnostics& diagnostics, const std::string& name)
    : chunks_sent(diagnostics.counter(name + "/chunks sent")),
      chunks_sent_again(diagnostics.counter(name + "/chunks sent again")),
      items_arrived(diagnostics.counter(name + "/items arrived")),
      items_lacking(diagnostics.counter(name + "/items lacking")),
      items_given_up(diagnostics.counter(name + "/items given up")),
      round_trip_us(diagnostics.counter(name + "/round trip us")),
      link_kbit_s(diagnostics.counter(name + "/link kbit_s")) {}

void FarReader::hear(const rds_msgs::msg::TransferRequest& request, Time now) {
  heard_ = now;
  if (!figures_) return;
  figures_->round_trip_us = request.round_trip_us();
  figures_->link_kbit_s = request.link_kbit_s();
}

void FarReader::hear_of_items(const rds_msgs::msg::TransferRequest& request, Time now) {
  instance_ = request.instance();
  backlog_.set(request.lacking(), now);
  given_up_.set(request.given_up(), now);
  if (!figures_) return;
  figures_->items_arrived = request.arrived();
  figures_->items_lacking = request.lacking();
  figures_->items_given_up = request.given_up();
}

bool FarReader::send(const rds_msgs::msg::TransferChunk& message) {
  const Chunk chunk{message.number(), message.item_bytes(), message.index(), {}};
  const bool again = sent_.note(message.reader(), static_cast<Stream>(message.stream()), chunk);
  chunks_.write(message);
  if (figures_) {
    ++figures_->chunks_sent;
    if (again) ++figures_->chunks_sent_again;
  }
  return again;
}

}  // namespace rds::transfer
