// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "common/bus/participant.hpp"
#include "tools/rds/run/services/run_options.hpp"

namespace rds::run {

/// How a participant of a run joins its bus. @throws std::runtime_error for credentials.
bus::ParticipantOptions run_participant(const RunOptions& options, int domain, const std::string& node_name);

/// `rds run` itself as a participant of its run. @throws bus::BusError; std::runtime_error for credentials.
std::unique_ptr<bus::Participant> join_bus(const RunOptions& options, int domain);

}  // namespace rds::run
