// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "common/bus/participant.hpp"
#include "common/bus/service_type.hpp"

namespace rds::bus {

namespace detail {

class ServiceEndpoint {
 public:
  virtual ~ServiceEndpoint() = default;
  /// Its requests.
  [[nodiscard]] virtual EndpointStatistics statistics() const = 0;
};

/// A request, and how to answer it: once, from any thread. @return false if nobody takes the answer.
using ServiceHandler =
    std::function<void(std::shared_ptr<const void> request, std::function<bool(const void*)> answer)>;

/// Who can serve; every participant that Participant::create() makes.
class ServiceHost {
 public:
  virtual ~ServiceHost() = default;
  virtual std::unique_ptr<ServiceEndpoint> make_service(const std::string& name, const ServiceType& type,
                                                        ServiceHandler handler) = 0;
};

}  // namespace detail

/// Keeps a service on the bus; after its destructor returns its handler is not running and never runs again.
class ServiceServer {
 public:
  ServiceServer() = default;
  explicit ServiceServer(std::unique_ptr<detail::ServiceEndpoint> endpoint)
      : endpoint_(std::move(endpoint)) {}

 private:
  std::unique_ptr<detail::ServiceEndpoint> endpoint_;
};

/// How a request is answered: once, from any thread, also after the handler has returned. @return false if
/// nobody takes the answer: who asked, or the service itself, is gone.
template <class Response>
using Answer = std::function<bool(const Response&)>;

/// Offers a service of ROS 2 whose requests are answered later. The handler runs on a thread of the service
/// alone, one request after the other: it passes the request on, and never waits.
///
/// Requests beyond the ten newest that wait are lost. A request counts as dropped where it is lost, cannot be
/// decoded, makes the handler throw, or nobody takes its answer; once there was one, the participant's
/// statistics name the service.
/// @param name  as of topics: see TopicNames::full_name().
/// @throws BusError
template <class Request, class Response>
ServiceServer serve_later(Participant& participant, const std::string& name,
                          std::function<void(std::shared_ptr<const Request>, Answer<Response>)> handler) {
  auto& host = dynamic_cast<detail::ServiceHost&>(participant);
  return ServiceServer(host.make_service(
      name, service_type<Request, Response>(),
      [handler = std::move(handler)](std::shared_ptr<const void> request,
                                     std::function<bool(const void*)> answer) {
        handler(std::static_pointer_cast<const Request>(std::move(request)),
                [answer = std::move(answer)](const Response& response) { return answer(&response); });
      }));
}

/// As serve_later(), with a handler that gives the answer at once.
template <class Request, class Response>
ServiceServer serve(Participant& participant, const std::string& name,
                    std::function<Response(const Request&)> handler) {
  return serve_later<Request, Response>(
      participant, name,
      [handler = std::move(handler)](const std::shared_ptr<const Request>& request,
                                     const Answer<Response>& answer) { answer(handler(*request)); });
}

}  // namespace rds::bus
