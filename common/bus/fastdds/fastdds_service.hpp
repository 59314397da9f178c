// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/topic/Topic.hpp>

#include "common/bus/fastdds/fastdds_reader.hpp"

namespace rds::bus::detail {

/// A service in the form of rmw_fastrtps: a request says in its sample's related identity which reader waits
/// for the reply, a reply says there whose request, and which, it answers. @throws BusError
std::unique_ptr<BackendService> make_fastdds_service(std::unique_ptr<FastReader> requests,
                                                     dds::Publisher* publisher, dds::Topic* reply_topic,
                                                     const dds::DataWriterQos& qos);

}  // namespace rds::bus::detail
