// SPDX-License-Identifier: Apache-2.0
#include "common/bus/dds/node_announcer.hpp"

#include <algorithm>
#include <utility>

#include "rmw_dds_common/msg/ParticipantEntitiesInfo.h"

namespace rds::bus::detail {
namespace {

using rmw_dds_common::msg::Gid;
using rmw_dds_common::msg::ParticipantEntitiesInfo;

Gid to_gid(const Guid& guid) {
  Gid gid;  // zero beyond the 16 bytes of the GUID
  std::transform(guid.begin(), guid.end(), gid.data().begin(),
                 [](std::uint8_t b) { return static_cast<char>(b); });
  return gid;
}

void append(const std::vector<Guid>& guids, std::vector<Gid>& gids) {
  std::transform(guids.begin(), guids.end(), std::back_inserter(gids), to_gid);
}

}  // namespace

NodeAnnouncer::NodeAnnouncer(Backend& backend, std::string node_name)
    : participant_(backend.guid()),
      node_name_(std::move(node_name)),
      writer_(backend.make_writer("ros_discovery_info", type_ops<ParticipantEntitiesInfo>(), kLatched)) {
  publish();
}

void NodeAnnouncer::add_writer(const Guid& guid) {
  const std::lock_guard lock(mutex_);
  writers_.push_back(guid);
  publish();
}

void NodeAnnouncer::add_reader(const Guid& guid) {
  const std::lock_guard lock(mutex_);
  readers_.push_back(guid);
  publish();
}

void NodeAnnouncer::remove(const Guid& guid) {
  const std::lock_guard lock(mutex_);
  std::erase(writers_, guid);
  std::erase(readers_, guid);
  publish();
}

void NodeAnnouncer::publish() const {
  ParticipantEntitiesInfo info;
  info.gid(to_gid(participant_));
  auto& node = info.node_entities_info_seq().emplace_back();
  node.node_namespace("/");
  node.node_name(node_name_);
  append(readers_, node.reader_gid_seq());
  append(writers_, node.writer_gid_seq());
  writer_->write(&info);
}

}  // namespace rds::bus::detail
