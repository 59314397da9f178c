// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>
#include <dds/ddsi/ddsi_sertype.h>

#include "common/bus/backend.hpp"

namespace rds::bus::detail {

/// A Cyclone DDS type that carries any message type as its CDR bytes. A writer gives dds_write() a message, a
/// reader gives ddsi_serdata_to_sample() a Sample. The caller owns one reference.
ddsi_sertype* make_cyclonedds_type(const TypeOps& type);

}  // namespace rds::bus::detail
