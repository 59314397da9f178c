// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <thread>

#include "common/bus/message_pool.hpp"
#include "common/bus/participant_state.hpp"
#include "common/bus/service_server.hpp"

namespace rds::bus::detail {

/// Takes requests on a thread of its own and hands them to the handler.
class ServerEndpoint final : public ServiceEndpoint {
 public:
  ServerEndpoint(std::shared_ptr<ParticipantState> state, const std::string& name, const ServiceType& type,
                 ServiceHandler handler)
      : handler_(std::move(handler)),
        request_(type.request),
        pool_(type.request),
        service_(std::make_shared<Service>(std::move(state), name, type)),
        thread_([this](const std::stop_token& stop) { run(stop); }) {
    const std::lock_guard lock(service_->state->mutex);
    service_->state->services.insert(this);
  }
  ~ServerEndpoint() override {
    {
      const std::lock_guard lock(service_->state->mutex);
      service_->state->services.erase(this);
    }
    thread_.request_stop();
    service_->backend->wake();
    thread_.join();
  }
  ServerEndpoint(const ServerEndpoint&) = delete;
  ServerEndpoint& operator=(const ServerEndpoint&) = delete;

  [[nodiscard]] EndpointStatistics statistics() const override {
    return {.topic = service_->name,
            .messages = service_->requests,
            .bytes = service_->bytes,
            .dropped = service_->dropped + service_->backend->lost(),
            .another_version = service_->another_version};
  }

 private:
  /// What answers need that come later.
  struct Service {
    Service(std::shared_ptr<ParticipantState> participant, std::string full_name, const ServiceType& type)
        : state(std::move(participant)),
          name(std::move(full_name)),
          backend(state->backend->make_service(name, type)) {}

    bool reply(const Caller& caller, const void* response) {
      const bool written = backend->reply(caller, response);
      if (!written) ++dropped;
      return written;
    }

    std::shared_ptr<ParticipantState> state;  // outlives the back end's endpoints
    std::string name;
    std::unique_ptr<BackendService> backend;
    std::atomic<std::uint64_t> requests = 0;
    std::atomic<std::uint64_t> bytes = 0;
    std::atomic<std::uint64_t> dropped = 0;
    std::atomic<std::uint64_t> another_version = 0;  // of these
  };

  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      service_->backend->wait();
      while (!stop.stop_requested() && take_one()) {
      }
      pool_.clear();  // the next request may be long in coming
    }
  }

  bool take_one() {
    const std::shared_ptr<void> request = pool_.get();
    Sample sample{.type = &request_, .message = request.get()};
    Caller caller;
    if (!service_->backend->take(sample, caller)) return false;
    if (sample.decoded) {
      ++service_->requests;
      service_->bytes += sample.bytes;
      call(request, caller);
    } else {
      ++service_->dropped;
      if (sample.another_version) ++service_->another_version;
    }
    return true;
  }

  void call(const std::shared_ptr<void>& request, const Caller& caller) {
    try {
      handler_(request, [service = std::weak_ptr(service_), caller](const void* response) {
        const auto there = service.lock();
        return there && there->reply(caller, response);
      });
    } catch (const std::exception&) {
      ++service_->dropped;
    }
  }

  ServiceHandler handler_;
  const TypeOps& request_;
  MessagePool pool_;
  std::shared_ptr<Service> service_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace rds::bus::detail
