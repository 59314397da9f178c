// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rds::recording {

/// offered_qos_profiles of one publisher as rosbag2 writes them: YAML, policies as the numbers that all its
/// versions read. History and depth are not on the wire, so they are unknown, as for rosbag2.
std::string offered_qos_profile(bool reliable, bool transient_local);

}  // namespace rds::recording
