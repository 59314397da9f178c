// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/bus/participant.hpp"
#include "tools/rds/run/services/run_options.hpp"

namespace rds::run {

/// `rds run` itself as a participant of its run. @throws bus::BusError; std::runtime_error for credentials.
std::unique_ptr<bus::Participant> join_bus(const RunOptions& options, int domain);

}  // namespace rds::run
