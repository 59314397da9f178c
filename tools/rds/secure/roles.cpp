// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/secure/roles.hpp"

#include <algorithm>

#include "common/topics/table.hpp"
#include "common/topics/topics.hpp"

namespace rds::secure {
namespace {

using Topics = std::vector<std::string>;

Topics operator+(Topics left, const Topics& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

/// On which readers of the map hear what they have asked for, each on one of its own.
std::string map_chunks() {
  return std::string(topics::kMapChunks.name) + "/*";
}

/// A service writes what the table of topics says, and reads all: services trust each other's pictures and
/// maps, but none writes for another.
Role service(const std::string& name, topics::Process process, const Topics& reads_besides = {}) {
  Topics written = topics::written_by(process);
  std::ranges::replace(written, topics::kMapChunks.name, map_chunks());
  return {name, written, Topics{"rds/*", topics::kDiagnostics.name} + reads_besides};
}

/// What a driver may offer beside the topics that are named: compressed pictures, the depth camera's model.
Topics besides(const Topics& camera_topics) {
  Topics all = camera_topics;
  for (const std::string& topic : camera_topics) {
    all.push_back(topic + "/*");
    all.push_back(topic.substr(0, topic.find_last_of('/')) + "/camera_info");
  }
  return all;
}

}  // namespace

std::vector<Role> roles(const RobotTopics& robot) {
  const Topics& camera_topics = robot.camera;
  const Topics diagnostics{topics::kDiagnostics.name};
  const Topics mounting{topics::kStaticTransforms.name};
  const Topics transforms = Topics{topics::kTransforms.name} + mounting;
  const Topics played = camera_topics + mounting + robot.sensors;
  const Topics poses{topics::kOdometry.name, topics::kTransforms.name, topics::kTrackingState.name,
                     topics::kTrajectory.name};
  return {
      service("tracker", topics::kTracker, besides(camera_topics) + transforms + robot.sensors),
      service("detector", topics::kDetector),
      service("transformer", topics::kTransformer, camera_topics),
      service("mapper", topics::kMapper),
      service("loop-closer", topics::kLoopCloser),
      service("viewer", topics::kViewer, transforms + camera_topics),
      {"operator",
       Topics{topics::kCommand.name, topics::kRunRequest.name, topics::kRunReply.name,
              topics::kMapRequests.name} +
           played,
       Topics{"rds/*", topics::kTransforms.name} + diagnostics + played},
      {"reader",
       {topics::kMapRequests.name},  // asks for what it lacks, where the mapper is on another machine
       Topics{"rds/map/*", topics::kBoxes.name, topics::kServiceStatus.name} + poses + diagnostics},
      {"player", played, {topics::kTrackingState.name, topics::kServiceStatus.name}},
      {"camera", camera_topics + mounting, {}},
      {"robot", transforms + robot.sensors, transforms + Topics{topics::kOdometry.name}},
      {"router", {}, {}, true},
  };
}

}  // namespace rds::secure
