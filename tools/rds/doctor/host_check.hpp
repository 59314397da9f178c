// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/bus/participant.hpp"
#include "tools/rds/doctor/checks/finding.hpp"

namespace rds::doctor {

/// Processor and memory of this machine.
Finding check_processor();
Finding check_memory();
/// Free space where results would be written.
Finding check_disk(const std::filesystem::path& folder);
/// Largest socket buffer a process may ask for; picture-sized messages want 4 MB.
Finding check_receive_buffer();
/// A datagram sent to a multicast group on the loopback interface comes back: how processes find each other.
Finding check_loopback_multicast();
/// ROS_DOMAIN_ID as it stands in the environment; null: not set.
Finding check_domain(const char* ros_domain_id);
/// A participant of this vendor can be made, on the loopback interface.
Finding check_vendor(bus::Vendor vendor);
/// The detector's networks and which would be used.
Finding check_networks();

/// All of the above for this process, results going to the current folder.
std::vector<Finding> check_host();

}  // namespace rds::doctor
