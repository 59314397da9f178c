// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace rds::tools {

/// `rds topic list|echo|hz|bw`: looks at the live bus, whichever process publishes.
///
/// The callbacks print to stdout. A topic that nobody publishes in time, or that stays silent: one sentence
/// to stderr and CLI::RuntimeError(1). Ctrl-C ends them early, as if all had been seen.
void add_topic_command(CLI::App& rds);

}  // namespace rds::tools
