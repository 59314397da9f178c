// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "common/service/service.hpp"
#include "tests/support/test_domain.hpp"

namespace rds::transfer {

/// A process on the bus, which other machines could reach as far as it knows.
struct Node {
  Node(bus::Vendor vendor, const std::string& name)
      : bus(bus::Participant::create(
            {.vendor = vendor, .domain = test::test_domain(), .node_name = name, .loopback_only = true})),
        context{"rds-" + name, *bus, diagnostics} {}

  /// One of its figures; 0 where there is none of this name.
  [[nodiscard]] std::uint64_t figure(const std::string& name) const {
    for (const auto& [its_name, value] : diagnostics.figures())
      if (its_name == name) return std::stoull(value);
    return 0;
  }

  std::unique_ptr<bus::Participant> bus;
  service::Diagnostics diagnostics;
  service::ServiceContext context;
};

}  // namespace rds::transfer
