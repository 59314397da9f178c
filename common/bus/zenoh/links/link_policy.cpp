// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/links/link_policy.hpp"

#include <memory>
#include <utility>

#include "common/bus/zenoh/links/link_notices.hpp"

namespace rds::bus {
namespace {

struct Links {
  LinkPolicy policy;
  std::unique_ptr<detail::LinkNotices> notices;
};

/// Never ends: Zenoh's threads do not, either.
Links& links() {
  static Links& of_process = *new Links;
  return of_process;
}

}  // namespace

void set_link_policy(LinkPolicy policy) {
  if (policy.tell) links().notices = std::make_unique<detail::LinkNotices>(policy.tell);
  links().policy = std::move(policy);
}

namespace detail {

const LinkPolicy& link_policy() {
  return links().policy;
}

void ignore_endpoint(const std::string& endpoint) {
  if (links().notices) links().notices->ignore(endpoint);
}

void take_log_line(const char* text, std::size_t size) {
  if (links().notices) links().notices->take({text, size});
}

}  // namespace detail
}  // namespace rds::bus
