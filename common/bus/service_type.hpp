// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/bus/type_ops.hpp"

namespace rds::bus {

/// What a service of ROS 2 is made of.
struct ServiceType {
  const TypeOps& request;
  const TypeOps& response;
  const char*
      type_hash;  // of both together, as a service ("RIHS01_<64 hex>"); DDS knows those of the two alone
};

/// The hash of the service with this request; specialised for every one of idl/ by common/messages.
template <class Request>
const char* service_type_hash();

template <class Request, class Response>
ServiceType service_type() {
  return {type_ops<Request>(), type_ops<Response>(), service_type_hash<Request>()};
}

}  // namespace rds::bus
