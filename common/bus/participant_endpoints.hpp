// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <thread>
#include <type_traits>

#include "common/bus/message_pool.hpp"
#include "common/bus/participant_state.hpp"

namespace rds::bus::detail {

class WriterEndpoint final : public PublisherEndpoint, public Endpoint {
 public:
  WriterEndpoint(std::shared_ptr<ParticipantState> state, const std::string& topic, const TypeOps& type,
                 const Qos& qos)
      : Endpoint(std::move(state), topic, type, qos, true),
        writer_(state_->backend->make_writer(full_name_, type, qos)) {
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
  [[nodiscard]] std::uint64_t lost() const override { return writer_->lost(); }

  std::unique_ptr<BackendWriter> writer_;
};

/// Waits, decodes and calls back on a thread of its own.
///
/// Where its QoS follows the publishers and hears nothing, as all of them offer best effort only, another
/// reader that asks for no more takes the first one's place.
class ReaderEndpoint final : public SubscriptionEndpoint, public Endpoint {
 public:
  using Callback = std::function<void(std::shared_ptr<const void>, const ParticipantId&)>;

  ReaderEndpoint(std::shared_ptr<ParticipantState> state, const std::string& topic, const TypeOps& type,
                 const Qos& qos, Callback callback)
      : Endpoint(std::move(state), topic, type, qos, false),
        callback_(std::move(callback)),
        pool_(type),
        reader_(state_->backend->make_reader(full_name_, type, qos)),
        thread_([this](const std::stop_token& stop) { run(stop); }) {
    enter();
  }
  ~ReaderEndpoint() override {
    leave();
    thread_.request_stop();
    with_reader([](BackendReader& reader) { reader.wake(); });
    thread_.join();
  }

  [[nodiscard]] int matched() const override {
    return with_reader([](const BackendReader& reader) { return reader.matched(); });
  }

 private:
  [[nodiscard]] Guid guid() const override {
    return with_reader([](const BackendReader& reader) { return reader.guid(); });
  }
  [[nodiscard]] std::uint64_t lost() const override {
    if (!qos_.counts_lost) return 0;
    return with_reader([](const BackendReader& reader) { return reader.lost(); });
  }
  /// For other threads than its own, which alone exchanges the reader.
  template <class Ask>
  std::invoke_result_t<Ask, BackendReader&> with_reader(Ask ask) const {
    const std::lock_guard lock(reader_mutex_);
    return ask(*reader_);
  }

  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      if (!reader_->wait_for(qos_.follows_publishers ? kFollowAfter : kIdleAfter)) {
        pool_.clear();
        if (!qos_.follows_publishers) {
          reader_->wait();
        } else if (reliable_ && best_effort_is_all_that_is_offered()) {
          ask_for_best_effort();
          continue;
        }
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

  [[nodiscard]] bool best_effort_is_all_that_is_offered() const {
    bool is_offered = false;
    for (const DiscoveredEndpoint& endpoint : state_->backend->discovered()) {
      if (!endpoint.publisher || endpoint.topic != full_name_ || endpoint.type != type_.dds_name) continue;
      if (endpoint.reliable) return false;
      is_offered = true;
    }
    return is_offered;
  }

  void ask_for_best_effort() {
    Qos less = qos_;
    less.reliable = false;
    std::unique_ptr<BackendReader> reader = state_->backend->make_reader(full_name_, type_, less);
    {
      const std::lock_guard lock(reader_mutex_);
      reader_.swap(reader);
    }
    reliable_ = false;
  }

  static constexpr std::chrono::seconds kIdleAfter{2};  // then no memory is kept for the next message
  static constexpr std::chrono::seconds kFollowAfter{1};

  Callback callback_;
  MessagePool pool_;
  mutable std::mutex reader_mutex_;  // of which reader it is
  std::unique_ptr<BackendReader> reader_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace rds::bus::detail
