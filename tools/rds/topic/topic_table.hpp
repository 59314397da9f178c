// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rds::tools {

/// The table of topics of common/topics as a table of Markdown: name, type, what its writers offer, who
/// writes, who reads.
std::string topic_table();

}  // namespace rds::tools
