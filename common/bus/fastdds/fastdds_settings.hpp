// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

#include "common/bus/backend.hpp"

/// The settings of Fast DDS that common/bus/README.md explains.
namespace rds::bus::detail {

/// A default participant profile in the user's FASTRTPS_DEFAULT_PROFILES_FILE replaces transports and
/// discovery.
eprosima::fastdds::dds::DomainParticipantQos fastdds_participant_qos(const ParticipantOptions& options);
eprosima::fastdds::dds::DataWriterQos fastdds_writer_qos(const TypeOps& type, const Qos& qos);
eprosima::fastdds::dds::DataReaderQos fastdds_reader_qos(const TypeOps& type, const Qos& qos);

}  // namespace rds::bus::detail
