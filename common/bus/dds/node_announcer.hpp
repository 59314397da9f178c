// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/bus/backend.hpp"

namespace rds::bus::detail {

struct NodeName {
  std::string node_namespace;  // "/robot1"
  std::string name;
};

/// Tells ROS 2 tools (`ros2 node list`, `ros2 node info`) on topic ros_discovery_info which node this
/// participant is and which endpoints belong to it, in the form of one distribution. Safe to call from any
/// thread.
class NodeAnnouncer {
 public:
  NodeAnnouncer(Backend& backend, NodeName node, RosDistro distro);

  void add_writer(const Guid& guid);
  void add_reader(const Guid& guid);
  void remove(const Guid& guid);

 private:
  void publish() const;
  template <class Info>
  void publish_as() const;

  std::mutex mutex_;
  Guid participant_;
  NodeName node_;
  RosDistro distro_;
  std::unique_ptr<BackendWriter> writer_;
  std::vector<Guid> writers_;
  std::vector<Guid> readers_;
};

}  // namespace rds::bus::detail
