// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/secure/roles.hpp"

namespace rds::secure {
namespace {

using Topics = std::vector<std::string>;

Topics operator+(Topics left, const Topics& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

/// What every service says and reads: services trust each other's pictures and maps, but none writes for
/// another.
Role service(const std::string& name, const Topics& publishes, const Topics& reads_besides = {}) {
  return {name, publishes + Topics{"rds/services", "rds/command_result", "diagnostics"},
          Topics{"rds/*", "diagnostics"} + reads_besides};
}

}  // namespace

std::vector<Role> roles(const Topics& camera_topics) {
  return {
      service("tracker",
              {"rds/odometry", "tf", "rds/tracking_state", "rds/predicted_boxes", "rds/features",
               "rds/keyframe/images", "rds/keyframe/features", "rds/keyframe/poses"},
              camera_topics),
      service("detector", {"rds/detections"}),
      service("transformer", {"rds/boxes"}, camera_topics),
      service("mapper", {"rds/map/*"}),
      service("loop-closer", {"rds/keyframe/poses"}),
      {"operator", Topics{"rds/command"} + camera_topics,
       Topics{"rds/*", "tf", "diagnostics"} + camera_topics},
      {"reader",
       {},
       {"rds/map/*", "rds/odometry", "rds/tracking_state", "rds/boxes", "rds/services", "tf", "diagnostics"}},
      {"player", camera_topics, {"rds/tracking_state"}},
      {"camera", camera_topics, {}},
  };
}

}  // namespace rds::secure
