// SPDX-License-Identifier: Apache-2.0
#include "common/bus/cyclonedds/cyclonedds_domain.hpp"

#include <cstdlib>
#include <map>
#include <mutex>

#include <dds/dds.h>

#include "common/bus/dds/dds_settings.hpp"

namespace rds::bus::detail {
namespace {

/// MaxMessageSize and FragmentSize: with the defaults a third of the pictures to a Fast DDS reader is lost.
/// GenerateKeyhash: without it Fast DDS does not understand that an endpoint or participant has left.
/// WhcHigh: never above it, or a slow reader would throttle the writer; the history depth bounds the memory.
constexpr const char* kCommonSettings =
    "<CycloneDDS><Domain Id=\"any\">"
    "<General><MaxMessageSize>65500B</MaxMessageSize><FragmentSize>63000B</FragmentSize></General>"
    "<Internal>"
    "<SocketReceiveBufferSize min=\"default\" max=\"4MB\"/><SocketSendBufferSize min=\"default\" "
    "max=\"4MB\"/>"
    "<Watermarks><WhcLow>1GB</WhcLow><WhcHigh>1GB</WhcHigh><WhcHighInit>1GB</WhcHighInit>"
    "<WhcAdaptive>false</WhcAdaptive></Watermarks>"
    "<GenerateKeyhash>true</GenerateKeyhash>"
    "<MaxQueuedRexmitBytes>8MB</MaxQueuedRexmitBytes><NackDelay>10ms</NackDelay>"
    "</Internal>";

/// What several read goes to each of them: by multicast it would go to every machine, and pictures too.
constexpr const char* kNetworkSettings = "<General><AllowMulticast>spdp</AllowMulticast></General>";

constexpr const char* kLoopbackSettings =
    "<General><Interfaces><NetworkInterface address=\"127.0.0.1\" multicast=\"false\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General>";

/// Without the shared memory transport, whatever the user's file says: our types do not carry it.
constexpr const char* kNoSharedMemory =
    "<CycloneDDS><Domain "
    "Id=\"any\"><SharedMemory><Enable>false</Enable></SharedMemory></Domain></CycloneDDS>";

std::string discovery_settings(const ParticipantOptions& options) {
  std::string text = "<Discovery><SPDPInterval>" + std::to_string(announcement_period_s(options)) +
                     "s</SPDPInterval>" + "<LeaseDuration>" + std::to_string(kLeaseDurationS) +
                     "s</LeaseDuration>";
  if (options.loopback_only || !options.peers.empty()) {
    text += "<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>" +
            std::to_string(kLoopbackParticipants) +
            "</MaxAutoParticipantIndex><Peers><Peer Address=\"127.0.0.1\"/>";
    for (const std::string& address : options.peers) text += "<Peer Address=\"" + address + "\"/>";
    text += "</Peers>";
  }
  return text + "</Discovery>";
}

/// Later parts win, element by element.
std::string configuration(const ParticipantOptions& options) {
  std::string text = std::string(kCommonSettings) +
                     (options.loopback_only ? kLoopbackSettings : kNetworkSettings) +
                     discovery_settings(options) + "</Domain></CycloneDDS>,";
  const char* user = std::getenv("CYCLONEDDS_URI");
  if (user != nullptr && *user != '\0') text += std::string(user) + ",";
  return text + kNoSharedMemory;
}

struct Domain {
  explicit Domain(const ParticipantOptions& options) : loopback_only(options.loopback_only) {
    handle = dds_create_domain(static_cast<dds_domainid_t>(options.domain), configuration(options).c_str());
    if (handle < 0) {
      throw BusError("Cyclone DDS could not join domain " + std::to_string(options.domain) + ": " +
                     dds_strretcode(handle) + " (its configuration is ours and CYCLONEDDS_URI)");
    }
  }
  ~Domain() { dds_delete(handle); }
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;

  bool loopback_only;
  dds_entity_t handle = 0;
};

}  // namespace

std::shared_ptr<void> join_cyclonedds_domain(const ParticipantOptions& options) {
  static std::mutex mutex;
  static std::map<int, std::weak_ptr<Domain>> domains;
  const std::lock_guard lock(mutex);
  std::shared_ptr<Domain> domain = domains[options.domain].lock();
  if (domain == nullptr) {
    domain = std::make_shared<Domain>(options);
    domains[options.domain] = domain;
  } else if (domain->loopback_only != options.loopback_only) {
    throw BusError("this process is already in domain " + std::to_string(options.domain) +
                   (domain->loopback_only ? " on the loopback only" : " on the network"));
  }
  return domain;
}

}  // namespace rds::bus::detail
