// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/bus/participant.hpp"

namespace rds::run {

/// Process names of `rds run`. "rds" is the player and recorder itself.
inline const std::string kPlayer = "rds";
inline const std::string kTracker = "rds-tracker";
inline const std::string kDetector = "rds-detector";
inline const std::string kTransformer = "rds-transformer";
inline const std::string kMapper = "rds-mapper";
inline const std::string kLoopCloser = "rds-loop-closer";
inline const std::string kViewer = "rds-viewer";  // reads, and nobody waits for it

/// "rds-loop-closer" of "loop_closer", "loop-closer" or "rds-loop-closer"; empty if there is no such service.
std::string service_of(const std::string& name);

/// The name of a service's part in a saved map: "tracker" of "rds-tracker".
std::string part_of(const std::string& service);

/// One endpoint of a process, as its status tells.
struct Endpoint {
  std::string topic;
  bool publisher = false;
  int matched = 0;
};

using Endpoints = std::map<std::string, std::vector<Endpoint>>;  // by process name

/// @param player  whose endpoints are known here. @param statuses  answers of services, by name.
Endpoints endpoints_of(const bus::Participant& player, const std::map<std::string, std::string>& statuses);

/// Links between the running processes that are not up yet, one sentence each.
///
/// A volatile sample written before both ends know each other is lost, so a run starts when this is empty.
/// @param endpoints  by process name, as each process reported; a process that has not reported is a missing
/// link.
/// @param localize_only  the mapper does not listen to keyframes.
/// @param far  services on other machines than the tracker, which ask for keyframes (common/transfer).
std::vector<std::string> missing_links(const std::set<std::string>& running, const Endpoints& endpoints,
                                       bool localize_only = false, const std::set<std::string>& far = {});

}  // namespace rds::run
