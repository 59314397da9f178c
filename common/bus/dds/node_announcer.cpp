// SPDX-License-Identifier: Apache-2.0
#include "common/bus/dds/node_announcer.hpp"

#include <algorithm>
#include <iterator>
#include <type_traits>
#include <utility>

#include "rmw_dds_common/msg/HumbleParticipantEntitiesInfo.h"
#include "rmw_dds_common/msg/ParticipantEntitiesInfo.h"

namespace rds::bus::detail {
namespace {

using rmw_dds_common::msg::HumbleParticipantEntitiesInfo;
using rmw_dds_common::msg::ParticipantEntitiesInfo;

/// Zero beyond the 16 bytes of the GUID.
template <class Gid>
Gid to_gid(const Guid& guid) {
  Gid gid;
  std::ranges::copy(guid, gid.data().begin());
  return gid;
}

template <class Gid>
void append(const std::vector<Guid>& guids, std::vector<Gid>& gids) {
  std::transform(guids.begin(), guids.end(), std::back_inserter(gids), to_gid<Gid>);
}

/// Humble's message goes by the same name on the bus, and says no type hash.
const TypeOps& type_of(RosDistro distro) {
  static const TypeOps kOfHumble = [] {
    TypeOps type = type_ops<HumbleParticipantEntitiesInfo>();
    type.dds_name = type_ops<ParticipantEntitiesInfo>().dds_name;
    type.ros_name = type_ops<ParticipantEntitiesInfo>().ros_name;
    type.type_hash.clear();
    return type;
  }();
  return distro == RosDistro::kHumble ? kOfHumble : type_ops<ParticipantEntitiesInfo>();
}

}  // namespace

NodeAnnouncer::NodeAnnouncer(Backend& backend, NodeName node, RosDistro distro)
    : participant_(backend.guid()),
      node_(std::move(node)),
      distro_(distro),
      writer_(backend.make_writer("ros_discovery_info", type_of(distro), kLatched)) {
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
  if (distro_ == RosDistro::kHumble)
    publish_as<HumbleParticipantEntitiesInfo>();
  else
    publish_as<ParticipantEntitiesInfo>();
}

template <class Info>
void NodeAnnouncer::publish_as() const {
  Info info;
  using Gid = std::decay_t<decltype(info.gid())>;
  info.gid(to_gid<Gid>(participant_));
  auto& node = info.node_entities_info_seq().emplace_back();
  node.node_namespace(node_.node_namespace);
  node.node_name(node_.name);
  append<Gid>(readers_, node.reader_gid_seq());
  append<Gid>(writers_, node.writer_gid_seq());
  writer_->write(&info);
}

}  // namespace rds::bus::detail
