// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/zenoh/wire/zenoh_attachment.hpp"
#include "common/bus/zenoh/wire/zenoh_names.hpp"
#include "common/bus/zenoh/zenoh_inbox.hpp"
#include "common/bus/zenoh/zenoh_library.hpp"
#include "common/bus/zenoh/zenoh_settings.hpp"

namespace rds::test {

/// Calls a service over Zenoh as a client of rmw_zenoh does.
class ZenohCaller {
 public:
  ZenohCaller(const std::string& service, const bus::ServiceType& type, int domain)
      : key_(bus::detail::service_key(domain, service, type)),
        session_(bus::detail::open_zenoh(
            bus::detail::zenoh_settings({.domain = domain, .node_name = "client", .loopback_only = true}),
            nullptr)) {
    std::array<char, 33> id{};
    zenoh().id(session_.get(), id.data());
    const std::string own =
        bus::detail::service_token({domain, id.data(), "client"}, 1, service, type, false);
    gid_ = bus::detail::gid_of_token(own);
    token_ = bus::detail::declare_token(session_, own);
    // that of any server: another session, number and node
    std::string server = bus::detail::service_token({domain, "*", "*"}, 0, service, type, true);
    const std::string numbers = "/0/0/SS/%/%/";
    server.replace(server.find(numbers), numbers.size(), "/*/*/SS/%/*/");
    watch_ = bus::detail::declare_watch(session_, server, &count, servers_);
  }

  [[nodiscard]] bool is_matched() const { return *servers_ > 0; }

  bool send(const std::vector<std::uint8_t>& request) {
    std::uint8_t* data = nullptr;
    RdsZenohBuffer* buffer = zenoh().make_buffer(session_.get(), request.size(), false, &data);
    std::ranges::copy(request, data);
    const auto attachment = bus::detail::to_bytes({++sequence_, 0, gid_});
    constexpr std::uint64_t kTimeoutMs = 10'000;
    return zenoh().get(session_.get(), key_.c_str(), buffer, attachment.data(), attachment.size(), kTimeoutMs,
                       &push, new std::shared_ptr<Answers>(answers_),
                       &bus::detail::release_object<Answers>) != 0;
  }

  /// The answer to the newest request.
  std::optional<std::vector<std::uint8_t>> take() {
    const bus::detail::ZenohSample sample = answers_->pop();
    if (sample == nullptr) return std::nullopt;
    RdsZenohView view{};
    zenoh().view(sample.get(), &view);
    const auto attachment = bus::detail::parse_attachment({view.attachment, view.attachment_size});
    if (!attachment || attachment->gid != gid_ || attachment->sequence != sequence_) return std::nullopt;
    std::vector<std::uint8_t> bytes(view.size);
    zenoh().gather(sample.get(), bytes.data());
    return bytes;
  }

 private:
  using Answers = bus::detail::ZenohInbox<bus::detail::ZenohSample>;
  static const RdsZenohApi& zenoh() { return bus::detail::zenoh_library(); }
  static void push(void* answers, RdsZenohSample* sample) {
    (*static_cast<std::shared_ptr<Answers>*>(answers))->push(bus::detail::ZenohSample(sample), 0);
  }
  static void count(void* servers, const char* /*token*/, std::size_t /*size*/, int alive) {
    **static_cast<std::shared_ptr<std::atomic<int>>*>(servers) += alive != 0 ? 1 : -1;
  }

  std::string key_;
  bus::detail::ZenohSession session_;
  bus::detail::Guid gid_{};
  std::shared_ptr<Answers> answers_ = std::make_shared<Answers>(10'000);
  std::shared_ptr<std::atomic<int>> servers_ = std::make_shared<std::atomic<int>>(0);
  bus::detail::ZenohToken token_;
  bus::detail::ZenohWatch watch_;
  std::int64_t sequence_ = 0;
};

}  // namespace rds::test
