// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "common/service/service.hpp"
#include "common/store/checkpoint_writer.hpp"
#include "common/store/maps_folder.hpp"

namespace rds::service {

/// Opens the checkpoint of a service in its domain; the log says what was found, and diagnostics count
/// ("checkpoints written", "checkpoint writes failed", "checkpoints failed").
/// @param service  "mapper" …
/// @return nullptr where checkpoints are switched off, or cannot be kept: the log says why, and the service
/// goes on without.
std::unique_ptr<store::CheckpointWriter> open_checkpoints(ServiceContext& context,
                                                          const store::MapsConfig& config,
                                                          const std::string& service);

}  // namespace rds::service
