// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <thread>

#include "common/bus/message_pool.hpp"
#include "common/bus/participant_state.hpp"

namespace rds::bus::detail {

class WriterEndpoint final : public PublisherEndpoint, public Endpoint {
 public:
  WriterEndpoint(std::shared_ptr<ParticipantState> state, std::string topic, const TypeOps& type,
                 const Qos& qos)
      : Endpoint(std::move(state), std::move(topic), type, qos, true),
        writer_(state_->backend->make_writer(topic_, type, qos)) {
    enter();
  }
  ~WriterEndpoint() override { leave(); }

  bool write(const void* message) override {
    const bool written = writer_->write(message);
    if (written)
      count(type_.encoded_size(message));
    else
      ++dropped_;
    return written;
  }
  [[nodiscard]] int matched() const override { return writer_->matched(); }

 private:
  [[nodiscard]] Guid guid() const override { return writer_->guid(); }
  [[nodiscard]] std::uint64_t lost() const override { return 0; }

  std::unique_ptr<BackendWriter> writer_;
};

/// Waits, decodes and calls back on a thread of its own.
class ReaderEndpoint final : public SubscriptionEndpoint, public Endpoint {
 public:
  using Callback = std::function<void(std::shared_ptr<const void>, const ParticipantId&)>;

  ReaderEndpoint(std::shared_ptr<ParticipantState> state, std::string topic, const TypeOps& type,
                 const Qos& qos, Callback callback)
      : Endpoint(std::move(state), std::move(topic), type, qos, false),
        callback_(std::move(callback)),
        pool_(type),
        reader_(state_->backend->make_reader(topic_, type, qos)),
        thread_([this](const std::stop_token& stop) { run(stop); }) {
    enter();
  }
  ~ReaderEndpoint() override {
    leave();
    thread_.request_stop();
    reader_->wake();
    thread_.join();
  }

  [[nodiscard]] int matched() const override { return reader_->matched(); }

 private:
  [[nodiscard]] Guid guid() const override { return reader_->guid(); }
  [[nodiscard]] std::uint64_t lost() const override { return qos_.counts_lost ? reader_->lost() : 0; }

  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      if (!reader_->wait_for(kIdleAfter)) {
        pool_.clear();
        reader_->wait();
      }
      while (!stop.stop_requested() && take_one()) {
      }
    }
  }

  bool take_one() {
    const std::shared_ptr<void> message = pool_.get();
    Sample sample{.type = &type_, .message = message.get()};
    if (!reader_->take(sample)) return false;
    if (sample.decoded) {
      count(sample.bytes);
      call_back(message, sample.writer);
    } else {
      ++dropped_;
      if (sample.another_version) ++another_version_;
    }
    return true;
  }

  /// An exception must not end the process: the message counts as dropped.
  void call_back(const std::shared_ptr<void>& message, const ParticipantId& writer) {
    try {
      callback_(message, writer);
    } catch (const std::exception&) {
      ++dropped_;
    }
  }

  static constexpr std::chrono::seconds kIdleAfter{2};  // then no memory is kept for the next message

  Callback callback_;
  MessagePool pool_;
  std::unique_ptr<BackendReader> reader_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace rds::bus::detail
