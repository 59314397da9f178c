// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <fastdds/dds/topic/TopicDataType.hpp>

#include "common/bus/endpoint_directory.hpp"
#include "common/bus/hand_over.hpp"

namespace rds::bus::detail {

namespace rtps = eprosima::fastrtps::rtps;

inline Guid to_guid(const rtps::GUID_t& source) {
  Guid guid{};
  std::copy(std::begin(source.guidPrefix.value), std::end(source.guidPrefix.value), guid.begin());
  std::copy(std::begin(source.entityId.value), std::end(source.entityId.value), guid.begin() + 12);
  return guid;
}

/// What a reader gives Fast DDS to be filled. The writer's name comes only after the bytes, so while a writer
/// of another version is there they are kept until it is known.
struct Receipt {
  Sample& sample;
  VersionCheck<Guid>& versions;
  std::vector<std::uint8_t> kept = {};

  void take(const std::uint8_t* data, std::size_t size) {
    if (versions.others().empty()) {
      sample.decode(data, size);
    } else {
      kept.assign(data, data + size);
    }
  }
  void writer_is(const Guid& writer) {
    if (kept.empty()) return;
    sample.another_version = versions.others().contains(writer);
    if (!sample.another_version) sample.decode(kept.data(), kept.size());
  }
};

/// Carries any message type. A writer gives a message, a reader a Receipt: so a reader learns size and
/// outcome, and no bytes make Fast DDS itself stumble.
class CarriedType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  explicit CarriedType(const TypeOps& type) : type_(type) {
    setName(type.dds_name.c_str());
    m_typeSize = kFirstAllocation;
    m_isGetKeyDefined = false;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* message, rtps::SerializedPayload_t* payload) override {
    tell_read_by_all(payload->data);
    const std::size_t size = type_.encode(message, payload->data, payload->max_size);
    payload->length = static_cast<std::uint32_t>(size);
    payload->encapsulation = CDR_LE;
    return size > 0;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* receipt) override {
    static_cast<Receipt*>(receipt)->take(payload->data, payload->length);
    tell_read(payload->data);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* message) override {
    return [this, message] { return static_cast<std::uint32_t>(type_.encoded_size(message)); };
  }
  void* createData() override { return type_.create(); }
  void deleteData(void* message) override { type_.destroy(message); }
  bool getKey(void* /*message*/, rtps::InstanceHandle_t* /*handle*/, bool /*force_md5*/) override {
    return false;
  }

 private:
  static constexpr std::uint32_t kFirstAllocation = 256;  // bytes; grows with the first larger message
  const TypeOps& type_;
};

}  // namespace rds::bus::detail
