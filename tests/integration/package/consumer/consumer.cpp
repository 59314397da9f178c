// SPDX-License-Identifier: Apache-2.0
// A map of one voxel, and a look for a live one on a domain where there is none.
#include <iostream>

#include "services/mapper/reader/map_follower.hpp"

int main() {
  rds::mapper::OctreeReplica replica;
  replica.apply({.map_id = 1, .revision = 3, .resolution = 0.05, .keys = {32768, 32768, 32768},
                 .log_odds = {0.85F}, .labels = {0}, .colors = {1, 2, 3}});
  std::cout << "revision " << replica.revision() << ", " << replica.tree().size() << " nodes\n";
  const auto bus = rds::bus::Participant::create({.domain = 23, .node_name = "consumer", .loopback_only = true});
  rds::service::Diagnostics diagnostics;
  rds::service::ServiceContext context{"consumer", *bus, diagnostics};
  const rds::mapper::MapFollower follower(context);
  return follower.map().look([](const auto&, const auto&) {}) ? 1 : 0;
}
