// SPDX-License-Identifier: Apache-2.0
#include "common/bus/cyclonedds/cyclonedds_service.hpp"

#include <vector>

#include "common/bus/cyclonedds/request_header.hpp"
#include "common/bus/dds/service_topics.hpp"

namespace rds::bus::detail {
namespace {

struct FreeEndpoint {
  void operator()(dds_builtintopic_endpoint_t* endpoint) const { dds_builtintopic_free_endpoint(endpoint); }
};

bool has_reader_of(dds_entity_t writer, const ParticipantId& participant) {
  std::vector<dds_instance_handle_t> readers(64);
  for (;;) {
    const dds_return_t count = dds_get_matched_subscriptions(writer, readers.data(), readers.size());
    if (count < 0) return false;
    const bool are_all = static_cast<std::size_t>(count) <= readers.size();
    readers.resize(static_cast<std::size_t>(count));
    if (are_all) break;
  }
  return std::ranges::any_of(readers, [&](dds_instance_handle_t handle) {
    const std::unique_ptr<dds_builtintopic_endpoint_t, FreeEndpoint> reader(
        dds_get_matched_subscription_data(writer, handle));
    return reader && participant_of(to_guid(reader->participant_key)) == participant;
  });
}

class CycloneService final : public BackendService {
 public:
  CycloneService(std::unique_ptr<CycloneReader> requests, std::unique_ptr<CycloneWriter> replies,
                 const TypeOps& response)
      : requests_(std::move(requests)), replies_(std::move(replies)), response_(response) {
    dds_set_status_mask(replies_->entity(), DDS_PUBLICATION_MATCHED_STATUS);
  }

  void wait() override { requests_->wait(); }
  void wake() override { requests_->wake(); }

  bool take(Sample& sample, Caller& caller) override {
    MessageBytes bytes;
    Sample carried{.type = &as_bytes(*sample.type), .message = &bytes};
    if (!requests_->take(carried)) return false;
    sample.bytes = carried.bytes;
    sample.another_version = carried.another_version;
    sample.writer = carried.writer;
    const auto header = carried.decoded ? take_header(bytes) : std::nullopt;
    if (!header) return true;
    caller.participant = carried.writer;
    caller.request = header->sequence;
    for (std::size_t i = 0; i < sizeof header->client; ++i)
      caller.client[i] = static_cast<std::uint8_t>(header->client >> (8 * i));
    sample.decode(bytes.data(), bytes.size());
    return true;
  }

  bool reply(const Caller& caller, const void* response) override {
    if (!wait_for_reader_of(caller.participant)) return false;
    RequestHeader header{.sequence = caller.request};
    for (std::size_t i = 0; i < sizeof header.client; ++i)
      header.client |= std::uint64_t{caller.client[i]} << (8 * i);
    const MessageBytes bytes = encode_with_header(header, response_, response);
    return !bytes.empty() && replies_->write(&bytes);
  }

  [[nodiscard]] std::uint64_t lost() const override { return requests_->lost(); }
  [[nodiscard]] Guid request_reader() const override { return requests_->guid(); }
  [[nodiscard]] Guid reply_writer() const override { return replies_->guid(); }

 private:
  /// Which reader of the participant waits cannot be told: requests do not name it.
  bool wait_for_reader_of(const ParticipantId& participant) {
    if (has_reader_of(replies_->entity(), participant)) return true;
    const dds_time_t end = dds_time() + DDS_MSECS(kCallerDiscoveryMs);
    const Entity wait_set(dds_create_waitset(dds_get_participant(replies_->entity())), "a wait set");
    dds_waitset_attach(wait_set.get(), replies_->entity(), 0);
    do {
      (void)replies_->matched();  // takes the status back, which else ends the next waiting at once
      if (has_reader_of(replies_->entity(), participant)) return true;
    } while (dds_waitset_wait_until(wait_set.get(), nullptr, 0, end) > 0);
    return false;
  }

  std::unique_ptr<CycloneReader> requests_;
  std::unique_ptr<CycloneWriter> replies_;
  const TypeOps& response_;
};

}  // namespace

std::unique_ptr<BackendService> make_cyclonedds_service(std::unique_ptr<CycloneReader> requests,
                                                        std::unique_ptr<CycloneWriter> replies,
                                                        const TypeOps& response) {
  return std::make_unique<CycloneService>(std::move(requests), std::move(replies), response);
}

}  // namespace rds::bus::detail
