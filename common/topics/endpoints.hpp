// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "common/bus/participant.hpp"
#include "common/topics/topics.hpp"

namespace rds::topics {

/// Writes a topic as this process does. @throws bus::BusError; std::logic_error if it is no writer of it.
template <class Message>
bus::Publisher<Message> advertise(bus::Participant& bus, const Topic<Message>& topic, Process process) {
  return bus.advertise<Message>(topic.address(), qos_of(process, topic.writers, topic.name));
}

/// Reads a topic as this process does; the callback as for bus::Participant::subscribe().
/// @throws bus::BusError; std::logic_error if it is no reader of it.
template <class Message, class Callback>
bus::Subscription subscribe(bus::Participant& bus, const Topic<Message>& topic, Process process,
                            Callback callback) {
  return bus.subscribe<Message>(topic.address(), qos_of(process, topic.readers, topic.name),
                                std::move(callback));
}

}  // namespace rds::topics
