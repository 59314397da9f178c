// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <tl/expected.hpp>

namespace rds::map_file {

/// Gives a finished folder its name. What had this name before has the other one afterwards, and is the
/// caller's to remove: both names change in one step, so that one of the two is always there, and whole.
///
/// On file systems without such a step (some network ones) the old folder is moved aside first.
/// @param finished_parent, target_parent  open folders (or AT_FDCWD) that the names are below.
/// @return whether there was an old one; or why not, in words that can follow "TARGET: ".
tl::expected<bool, std::string> replace_folder(int finished_parent, const std::filesystem::path& finished,
                                               int target_parent, const std::filesystem::path& target);

}  // namespace rds::map_file
