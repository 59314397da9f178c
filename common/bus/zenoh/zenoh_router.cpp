// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/zenoh_router.hpp"

#include "common/bus/zenoh/zenoh_library.hpp"
#include "common/bus/zenoh/zenoh_settings.hpp"

namespace rds::bus {
namespace {

std::string settings_of(const ZenohRouterOptions& options) {
  if (!options.credentials) return detail::zenoh_router_settings(options.listen, options.connect);
  const detail::ZenohAccess access(*options.credentials);
  return detail::zenoh_router_settings(options.listen, options.connect, &access);
}

}  // namespace

struct ZenohRouter::Session {
  detail::ZenohSession session;
};

ZenohRouter::ZenohRouter(const ZenohRouterOptions& options)
    : session_(new Session{detail::open_zenoh(settings_of(options), detail::users_settings())}) {}
ZenohRouter::~ZenohRouter() = default;

}  // namespace rds::bus
