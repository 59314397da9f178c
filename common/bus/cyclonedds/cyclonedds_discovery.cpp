// SPDX-License-Identifier: Apache-2.0
#include "common/bus/cyclonedds/cyclonedds_discovery.hpp"

#include <atomic>
#include <cstdint>

#include <dds/ddsi/ddsi_plist.h>
#include <dds/ddsi/q_protocol.h>
#include <dds/ddsi/q_rtps.h>
#include <dlfcn.h>

namespace {

/// The four built-in endpoints through which participants ask each other for descriptions of types.
constexpr std::uint32_t kTypeLookup =
    NN_BUILTIN_ENDPOINT_TL_SVC_REQUEST_DATA_WRITER | NN_BUILTIN_ENDPOINT_TL_SVC_REQUEST_DATA_READER |
    NN_BUILTIN_ENDPOINT_TL_SVC_REPLY_DATA_WRITER | NN_BUILTIN_ENDPOINT_TL_SVC_REPLY_DATA_READER;

std::atomic<bool> announced = false;

/// The library's own definition of a function that is defined here, too.
template <class Function>
Function* library_function(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// The program's definitions come before the library's when the dynamic linker resolves the library's calls.
extern "C" {

/// Reads a received discovery message: type information is skipped unread, and no participant offers type
/// lookup. Without its built-in endpoints whatever it sends as type lookup is dropped as from an unknown
/// writer.
__attribute__((visibility("default"))) dds_return_t ddsi_plist_init_frommsg(
    ddsi_plist_t* list, char** next, std::uint64_t parameters, std::uint64_t policies,
    const ddsi_plist_src_t* source, const struct ddsi_domaingv* domain) {
  static const auto read = library_function<decltype(ddsi_plist_init_frommsg)>("ddsi_plist_init_frommsg");
  const dds_return_t result = read(list, next, parameters, policies & ~QP_TYPE_INFORMATION, source, domain);
  if (result == DDS_RETCODE_OK && (list->present & PP_BUILTIN_ENDPOINT_SET) != 0) {
    list->builtin_endpoint_set &= ~kTypeLookup;
  }
  return result;
}

/// Writes a discovery message of ours: it does not offer type lookup, or others would wait for our answers.
/// An endpoint says whose it is, which the library leaves to its GUID: Fast DDS 3 (ROS 2 Kilted) does not
/// look there, and its `ros2 topic info` would show endpoints without nodes.
__attribute__((visibility("default"))) void ddsi_plist_addtomsg(struct nn_xmsg* message,
                                                                const ddsi_plist_t* list,
                                                                std::uint64_t parameters,
                                                                std::uint64_t policies) {
  static const auto append = library_function<decltype(ddsi_plist_addtomsg)>("ddsi_plist_addtomsg");
  ddsi_plist_t without = *list;  // shares what it points to
  without.builtin_endpoint_set &= ~kTypeLookup;
  if ((list->present & PP_ENDPOINT_GUID) != 0 && (list->present & PP_PARTICIPANT_GUID) == 0) {
    without.present |= PP_PARTICIPANT_GUID;
    without.participant_guid = list->endpoint_guid;
    without.participant_guid.entityid.u = NN_ENTITYID_PARTICIPANT;
  }
  announced = true;
  append(message, &without, parameters, policies);
}

}  // extern "C"

namespace rds::bus::detail {

bool cyclonedds_discovery_is_filtered() {
  return announced;
}

}  // namespace rds::bus::detail
