// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/bus/cyclonedds/cyclonedds_reader.hpp"
#include "common/bus/cyclonedds/cyclonedds_writer.hpp"

namespace rds::bus::detail {

/// A service in the form of rmw_cyclonedds: requests and replies begin with a RequestHeader.
/// @param requests, replies  of as_bytes(). @param response  the type of the replies.
std::unique_ptr<BackendService> make_cyclonedds_service(std::unique_ptr<CycloneReader> requests,
                                                        std::unique_ptr<CycloneWriter> replies,
                                                        const TypeOps& response);

}  // namespace rds::bus::detail
