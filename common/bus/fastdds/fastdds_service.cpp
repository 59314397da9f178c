// SPDX-License-Identifier: Apache-2.0
#include "common/bus/fastdds/fastdds_service.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/rtps/common/WriteParams.h>

#include "common/bus/dds/service_topics.hpp"

namespace rds::bus::detail {
namespace {

const eprosima::fastrtps::Duration_t kLastAnswersLimit{1, 0};

rtps::GUID_t from_guid(const Guid& guid) {
  rtps::GUID_t target;
  std::copy_n(guid.begin(), 12, std::begin(target.guidPrefix.value));
  std::copy_n(guid.begin() + 12, 4, std::begin(target.entityId.value));
  return target;
}

/// Clients before ROS 2 Galactic do not name their reader, but are known by their writer.
bool is_reader(const Guid& guid) {
  constexpr std::uint8_t kReaderWithoutKey = 0x04;  // the last byte of a GUID (DDSI-RTPS, table 9.1)
  return guid.back() == kReaderWithoutKey;
}

/// The readers that a writer of replies is matched with, kept up to date by Fast DDS's discovery thread.
class MatchedReaders final : public dds::DataWriterListener {
 public:
  void on_publication_matched(dds::DataWriter* /*writer*/,
                              const dds::PublicationMatchedStatus& status) override {
    const Guid reader = to_guid(rtps::iHandle2GUID(status.last_subscription_handle));
    {
      const std::lock_guard lock(mutex_);
      if (status.current_count_change > 0)
        readers_.insert(reader);
      else
        readers_.erase(reader);
    }
    changed_.notify_all();
  }

  /// @return whether a reader of the caller's is there, after a moment at most.
  bool wait_for(const Caller& caller) {
    const auto is_his = [&](const Guid& reader) {
      return is_reader(caller.client) ? reader == caller.client
                                      : participant_of(reader) == caller.participant;
    };
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::milliseconds(kCallerDiscoveryMs),
                             [&] { return std::ranges::any_of(readers_, is_his); });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::set<Guid> readers_;
};

class FastService final : public BackendService {
 public:
  FastService(std::unique_ptr<FastReader> requests, dds::Publisher* publisher, dds::Topic* reply_topic,
              const dds::DataWriterQos& qos)
      : requests_(std::move(requests)),
        publisher_(publisher),
        writer_(publisher->create_datawriter(reply_topic, qos, &readers_,
                                             dds::StatusMask::publication_matched())) {
    if (writer_ == nullptr) throw BusError("Fast DDS refused a writer on " + reply_topic->get_name());
  }
  /// Answers leave first: Fast DDS drops at once what a reader has not acknowledged when its writer goes.
  ~FastService() override {
    writer_->wait_for_acknowledgments(kLastAnswersLimit);
    publisher_->delete_datawriter(writer_);
  }
  FastService(const FastService&) = delete;
  FastService& operator=(const FastService&) = delete;

  void wait() override { requests_->wait(); }
  void wake() override { requests_->wake(); }

  bool take(Sample& sample, Caller& caller) override {
    dds::SampleInfo info;
    if (!requests_->take(sample, info)) return false;
    const rtps::GUID_t& reader = info.related_sample_identity.writer_guid();
    caller.client = to_guid(reader != rtps::GUID_t::unknown() ? reader : info.sample_identity.writer_guid());
    caller.request = static_cast<std::int64_t>(info.sample_identity.sequence_number().to64long());
    caller.participant = sample.writer;
    return true;
  }

  bool reply(const Caller& caller, const void* response) override {
    if (!readers_.wait_for(caller)) return false;
    rtps::WriteParams parameters;
    rtps::SampleIdentity& request = parameters.related_sample_identity();
    request.writer_guid(from_guid(caller.client));
    request.sequence_number(rtps::SequenceNumber_t(static_cast<std::uint64_t>(caller.request)));
    return writer_->write(const_cast<void*>(response), parameters);
  }

  [[nodiscard]] std::uint64_t lost() const override { return requests_->lost(); }
  [[nodiscard]] Guid request_reader() const override { return requests_->guid(); }
  [[nodiscard]] Guid reply_writer() const override { return to_guid(writer_->guid()); }

 private:
  std::unique_ptr<FastReader> requests_;
  MatchedReaders readers_;
  dds::Publisher* publisher_;
  dds::DataWriter* writer_;
};

}  // namespace

std::unique_ptr<BackendService> make_fastdds_service(std::unique_ptr<FastReader> requests,
                                                     dds::Publisher* publisher, dds::Topic* reply_topic,
                                                     const dds::DataWriterQos& qos) {
  return std::make_unique<FastService>(std::move(requests), publisher, reply_topic, qos);
}

}  // namespace rds::bus::detail
