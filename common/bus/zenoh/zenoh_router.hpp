// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/security.hpp"

namespace rds::bus {

struct ZenohRouterOptions {
  // Endpoints of Zenoh, or names and addresses, with or without a port: tcp/[::]:7447, robot, 10.0.0.7:7448
  std::vector<std::string> listen;
  std::vector<std::string> connect;  // other routers
  std::optional<Credentials> credentials = {};
};

/// Passes on, as long as it lives, what those that dial it say, of all domains: for machines that do not
/// reach each other. @throws BusError
class ZenohRouter {
 public:
  explicit ZenohRouter(const ZenohRouterOptions& options);
  ~ZenohRouter();
  ZenohRouter(const ZenohRouter&) = delete;
  ZenohRouter& operator=(const ZenohRouter&) = delete;

 private:
  struct Session;
  std::unique_ptr<Session> session_;
};

}  // namespace rds::bus
