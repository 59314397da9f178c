// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "common/bus/backend.hpp"
#include "common/bus/cyclonedds/request_header.hpp"
#include "common/bus/dds/service_topics.hpp"
#include "tests/support/test_domain.hpp"
#include "tests/support/zenoh_caller.hpp"

namespace rds::test {

/// A client of a service on 127.0.0.1, made of plain endpoints: to a service on Cyclone DDS it speaks as
/// rmw_cyclonedds does; to one on Fast DDS as the oldest of rmw_fastrtps, which name no reader; on Zenoh as
/// rmw_zenoh.
template <class Request, class Response>
class ServiceClient {
 public:
  /// @param service  full name, without a leading slash.
  ServiceClient(bus::Vendor vendor, const std::string& service, int domain = test_domain())
      : vendor_(vendor) {
    if (vendor == bus::Vendor::kZenoh) {
      zenoh_ = std::make_unique<ZenohCaller>(service, bus::service_type<Request, Response>(), domain);
      return;
    }
    backend_ =
        make_backend({.vendor = vendor, .domain = domain, .node_name = "client", .loopback_only = true});
    writer_ = backend_->make_writer(bus::detail::request_topic(service), kRequest, bus::detail::kServiceQos);
    reader_ = backend_->make_reader(bus::detail::reply_topic(service), kResponse, bus::detail::kServiceQos);
  }

  /// Asks until it is answered: the service may not have found this client yet. @return nullopt after 20 s.
  std::optional<Response> call(const Request& request) {
    for (int i = 0; i < 100; ++i) {
      if (is_matched()) send(request);
      if (auto response = answer(std::chrono::milliseconds(200))) return response;
    }
    return std::nullopt;
  }

  [[nodiscard]] bool is_matched() const {
    if (zenoh_) return zenoh_->is_matched();
    return writer_->matched() > 0 && reader_->matched() > 0;
  }

  /// @return the number of the request, in Cyclone DDS's form.
  std::int64_t send(const Request& request) {
    const auto& type = bus::type_ops<Request>();
    if (vendor_ == bus::Vendor::kCycloneDds) {
      send_bytes(bus::detail::encode_with_header({kClient, ++sequence_}, type, &request));
    } else {
      Bytes bytes(type.encoded_size(&request));
      type.encode(&request, bytes.data(), bytes.size());
      send_bytes(bytes);
    }
    return sequence_;
  }
  bool send_bytes(const bus::detail::MessageBytes& bytes) {
    return zenoh_ ? zenoh_->send(bytes) : writer_->write(&bytes);
  }

  /// The next reply to this client's newest request.
  std::optional<Response> answer(std::chrono::milliseconds limit) {
    const auto end = std::chrono::steady_clock::now() + limit;
    do {
      if (auto response = take()) return response;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    } while (std::chrono::steady_clock::now() < end);
    return std::nullopt;
  }

 private:
  using Bytes = bus::detail::MessageBytes;
  static constexpr std::uint64_t kClient = 0x0123456789abcdef;

  static std::unique_ptr<bus::detail::Backend> make_backend(const bus::ParticipantOptions& options) {
    return options.vendor == bus::Vendor::kFastDds ? bus::detail::make_fastdds_backend(options)
                                                   : bus::detail::make_cyclonedds_backend(options);
  }

  std::optional<Response> take() {
    Bytes bytes;
    if (zenoh_) {
      auto answer = zenoh_->take();
      if (!answer) return std::nullopt;
      return decoded(*answer);
    }
    bus::detail::Sample sample{.type = &kResponse, .message = &bytes};
    if (!reader_->take(sample) || !sample.decoded) return std::nullopt;
    if (vendor_ == bus::Vendor::kCycloneDds) {
      const auto header = bus::detail::take_header(bytes);
      if (header != bus::detail::RequestHeader{kClient, sequence_}) return std::nullopt;
    }
    return decoded(bytes);
  }

  static std::optional<Response> decoded(const Bytes& bytes) {
    Response response;
    if (!bus::type_ops<Response>().decode(bytes.data(), bytes.size(), &response)) return std::nullopt;
    return response;
  }

  inline static const bus::TypeOps& kRequest = bus::detail::as_bytes(bus::type_ops<Request>());
  inline static const bus::TypeOps& kResponse = bus::detail::as_bytes(bus::type_ops<Response>());

  bus::Vendor vendor_;
  std::unique_ptr<bus::detail::Backend> backend_;
  std::unique_ptr<bus::detail::BackendWriter> writer_;
  std::unique_ptr<bus::detail::BackendReader> reader_;
  std::int64_t sequence_ = 0;
  std::unique_ptr<ZenohCaller> zenoh_;  // in place of the three above
};

}  // namespace rds::test
