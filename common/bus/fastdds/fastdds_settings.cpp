// SPDX-License-Identifier: Apache-2.0
#include "common/bus/fastdds/fastdds_settings.hpp"

#include <algorithm>
#include <mutex>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/log/StdoutErrConsumer.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>

#include "common/bus/dds/dds_settings.hpp"
#include "common/bus/dds/security_properties.hpp"
#include "common/bus/dds/user_data.hpp"

namespace rds::bus::detail {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

constexpr std::uint32_t kSocketBuffer = 4U << 20U;  // two and a half pictures of 1.5 MB
constexpr double kHeartbeatPeriodS = 0.2;           // default 3: a late joiner would wait that long
constexpr double kNackResponseDelayS = 0.001;
constexpr double kSlowNackResponseDelayS = 1;  // what TCP waits while it knows nothing of the way (RFC 6298)
constexpr int kLivelinessLeaseS = 100'000'000;  // three years
constexpr int kAnnouncementsAtStart = 10;
constexpr std::uint32_t kAnnouncementAtStartPeriodNs = 100'000'000;

/// Once, before the first participant: complaints go to stderr (stdout is for what a tool prints), the user's
/// profiles, and no short cut between participants of one process (it would run a reader's history under the
/// writer's lock; every participant of ours is a process anyway).
void prepare_library() {
  static std::once_flag once;
  std::call_once(once, [] {
    dds::Log::ClearConsumers();
    dds::Log::RegisterConsumer(std::make_unique<dds::StdoutErrConsumer>());
    dds::DomainParticipantFactory::get_instance()->load_profiles();
    auto settings = eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings();
    settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
    eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
  });
}

/// UDP only. Shared memory stays off: after a kill -9 a restarted reader waits for seconds or for ever.
/// Who is told of this participant without multicast: the first participants of a machine.
void add_peer(dds::DomainParticipantQos& qos, const std::string& address) {
  rtps::Locator_t peer;
  peer.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setIPv4(peer, address);
  qos.wire_protocol().builtin.initialPeersList.push_back(peer);
}

void set_transport(dds::DomainParticipantQos& qos, const ParticipantOptions& options) {
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->sendBufferSize = kSocketBuffer;
  udp->receiveBufferSize = kSocketBuffer;
  if (options.loopback_only) udp->interfaceWhiteList.emplace_back("127.0.0.1");
  if (options.loopback_only || !options.peers.empty()) {
    udp->maxInitialPeersRange = kLoopbackParticipants;
    add_peer(qos, "127.0.0.1");
  }
  if (!options.loopback_only)
    for (const std::string& address : options.peers) add_peer(qos, address);
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(std::move(udp));
}

void set_discovery(dds::DomainParticipantQos& qos, const ParticipantOptions& options) {
  auto& discovery = qos.wire_protocol().builtin.discovery_config;
  discovery.initial_announcements.count = kAnnouncementsAtStart;
  discovery.initial_announcements.period = {0, kAnnouncementAtStartPeriodNs};
  discovery.leaseDuration_announcementperiod = {announcement_period_s(options), 0};
  discovery.leaseDuration = {kLeaseDurationS, 0};
}

template <class EndpointQos>
void set_common(const TypeOps& type, const Qos& qos, EndpointQos& target) {
  target.reliability().kind = qos.reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
  target.durability().kind =
      qos.transient_local ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  const int depth = history_depth(qos);
  target.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  target.history().depth = depth;
  target.resource_limits().allocated_samples = std::min(depth + 1, 8);
  target.resource_limits().max_samples = std::max(depth, qos.max_samples);
  target.resource_limits().max_samples_per_instance = target.resource_limits().max_samples;
  target.resource_limits().max_instances = 1;
  // A pool would keep each of its buffers as large as the largest message that ever was in it.
  target.endpoint().history_memory_policy = rtps::DYNAMIC_RESERVE_MEMORY_MODE;
  target.data_sharing().off();
  const std::string user_data = endpoint_user_data(type);
  target.user_data().data_vec({user_data.begin(), user_data.end()});
}

}  // namespace

dds::DomainParticipantQos fastdds_participant_qos(const ParticipantOptions& options) {
  prepare_library();
  dds::DomainParticipantQos qos =
      dds::DomainParticipantFactory::get_instance()->get_default_participant_qos();
  if (qos == dds::PARTICIPANT_QOS_DEFAULT) {
    set_transport(qos, options);
    set_discovery(qos, options);
  }
  qos.name(options.node_name.c_str());
  const std::string user_data = kParticipantUserData;
  qos.user_data().data_vec({user_data.begin(), user_data.end()});
  if (options.credentials)
    for (const auto& [name, value] : fastdds_security(*options.credentials))
      qos.properties().properties().emplace_back(name, value);
  return qos;
}

dds::DataWriterQos fastdds_writer_qos(const TypeOps& type, const Qos& qos) {
  dds::DataWriterQos writer = dds::DATAWRITER_QOS_DEFAULT;
  set_common(type, qos, writer);
  writer.publish_mode().kind = dds::SYNCHRONOUS_PUBLISH_MODE;
  // Lets FastWriter send a heartbeat of its own; a lease without end would refuse that.
  writer.liveliness().kind = dds::MANUAL_BY_TOPIC_LIVELINESS_QOS;
  writer.liveliness().lease_duration = {kLivelinessLeaseS, 0};
  writer.liveliness().announcement_period = {kLivelinessLeaseS / 2, 0};
  writer.reliable_writer_qos().times.heartbeatPeriod = eprosima::fastrtps::Duration_t(kHeartbeatPeriodS);
  writer.reliable_writer_qos().times.nackResponseDelay =
      eprosima::fastrtps::Duration_t(qos.repairs_slowly ? kSlowNackResponseDelayS : kNackResponseDelayS);
  return writer;
}

dds::DataReaderQos fastdds_reader_qos(const TypeOps& type, const Qos& qos) {
  dds::DataReaderQos reader = dds::DATAREADER_QOS_DEFAULT;
  set_common(type, qos, reader);
  return reader;
}

}  // namespace rds::bus::detail
