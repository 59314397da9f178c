// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <stop_token>
#include <string>

#include <tl/expected.hpp>

#include "common/bus/participant.hpp"

namespace rds::map_commands {

/// What running services have saved.
struct LiveSave {
  std::filesystem::path folder;                   // of the map, on the services' machine
  std::map<std::string, std::string> by_service;  // what each has in it
};

/// Has the running tracker, mapper and loop closer save their parts as one map of this name, in their folder
/// of maps. A loop closer that does not answer is left out.
/// @return or one sentence: who did not answer in time, or could not write; then nothing is saved.
tl::expected<LiveSave, std::string> save_live_map(bus::Participant& participant, const std::string& name,
                                                  std::chrono::duration<double> timeout,
                                                  const std::stop_token& stop);

/// The same into a file, where the services' folder of maps can be seen from here.
tl::expected<void, std::string> save_live_map_as(bus::Participant& participant,
                                                 const std::filesystem::path& file,
                                                 std::chrono::duration<double> timeout,
                                                 const std::stop_token& stop);

/// Has the running services go on in a map of their folder of maps.
/// @return what each answered; or one sentence: who did not, or refused.
tl::expected<std::map<std::string, std::string>, std::string> load_live_map(
    bus::Participant& participant, const std::string& name, std::chrono::duration<double> timeout,
    const std::stop_token& stop);

}  // namespace rds::map_commands
