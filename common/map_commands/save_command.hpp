// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "common/map_file/joint_save.hpp"
#include "common/service/service.hpp"

namespace rds::map_commands {

/// What the command `save` asks for. Its argument is the name of a map, or JSON: {"name": N, "id": ID, "parts":
/// ["tracker", "mapper", "loop_closer"]}. A name alone means this service's part alone, or all parts if all
/// services were asked; the id is then that of the request.
/// @param own_part  of the service that was asked.
/// @return or one sentence: what is wrong with it.
tl::expected<map_file::SaveOrder, std::string> parse_save(const service::PendingCommand& command,
                                                          const std::string& own_part);

/// The answer to it, as JSON: map, id, state ("waits", "published", "complete"), folder of the map, and what
/// the service saved.
std::string save_answer(const map_file::SaveOrder& order, map_file::SaveState state,
                        const std::filesystem::path& maps, const std::string& what);

}  // namespace rds::map_commands
