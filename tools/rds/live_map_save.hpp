// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <stop_token>
#include <string>

#include <tl/expected.hpp>

#include "common/bus/participant.hpp"

namespace rds::tools {

/// Has the running tracker, mapper and loop closer write their parts of the map beside `file`, and makes one
/// of them. They must see the same file system. A loop closer that does not answer is left out.
///
/// @return or one sentence: who did not answer in time, or could not write.
tl::expected<void, std::string> save_live_map(bus::Participant& participant,
                                              const std::filesystem::path& file,
                                              std::chrono::duration<double> timeout,
                                              const std::stop_token& stop);

}  // namespace rds::tools
