// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <utility>

#include <fastdds/dds/core/condition/GuardCondition.hpp>
#include <fastdds/dds/core/condition/StatusCondition.hpp>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include "common/bus/fastdds/fastdds_type.hpp"

namespace rds::bus::detail {

namespace dds = eprosima::fastdds::dds;

/// A reader of any type; takes what a wait set has told of.
class FastReader final : public BackendReader {
  using ReturnCode = eprosima::fastrtps::types::ReturnCode_t;

 public:
  FastReader(dds::Subscriber* subscriber, dds::Topic* topic, const dds::DataReaderQos& qos,
             VersionCheck<Guid> versions)
      : subscriber_(subscriber),
        versions_(std::move(versions)),
        reader_(subscriber->create_datareader(topic, qos)) {
    if (reader_ == nullptr) throw BusError("Fast DDS refused a reader on " + topic->get_name());
    reader_->get_statuscondition().set_enabled_statuses(dds::StatusMask::data_available());
    wait_set_.attach_condition(reader_->get_statuscondition());
    wait_set_.attach_condition(stop_);
  }
  ~FastReader() override {
    wait_set_.detach_condition(stop_);
    wait_set_.detach_condition(reader_->get_statuscondition());
    subscriber_->delete_datareader(reader_);
  }
  FastReader(const FastReader&) = delete;
  FastReader& operator=(const FastReader&) = delete;

  void wait() override {
    dds::ConditionSeq active;
    wait_set_.wait(active, eprosima::fastrtps::c_TimeInfinite);
  }
  bool wait_for(std::chrono::seconds limit) override {
    dds::ConditionSeq active;
    return wait_set_.wait(active, {static_cast<std::int32_t>(limit.count()), 0}) == ReturnCode::RETCODE_OK;
  }
  void wake() override { stop_.set_trigger_value(true); }
  bool take(Sample& sample) override {
    dds::SampleInfo info;
    return take(sample, info);
  }
  /// @param info  of the sample, if there is one.
  bool take(Sample& sample, dds::SampleInfo& info) {
    Receipt receipt{sample, versions_};
    while (reader_->take_next_sample(&receipt, &info) == ReturnCode::RETCODE_OK) {
      if (!info.valid_data) continue;
      const Guid writer = to_guid(info.sample_identity.writer_guid());
      receipt.writer_is(writer);
      sample.writer = participant_of(writer);
      return true;
    }
    return false;
  }
  [[nodiscard]] std::uint64_t lost() const override {
    dds::SampleLostStatus status;
    reader_->get_sample_lost_status(status);
    return static_cast<std::uint64_t>(std::max(status.total_count, 0));
  }
  [[nodiscard]] int matched() const override {
    dds::SubscriptionMatchedStatus status;
    reader_->get_subscription_matched_status(status);
    return status.current_count;
  }
  [[nodiscard]] Guid guid() const override { return to_guid(reader_->guid()); }

 private:
  dds::Subscriber* subscriber_;
  VersionCheck<Guid> versions_;
  dds::DataReader* reader_;
  dds::WaitSet wait_set_;
  dds::GuardCondition stop_;
};

}  // namespace rds::bus::detail
