// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/rds/secure/certificate_authority.hpp"
#include "tools/rds/secure/roles.hpp"

/// The two documents of DDS Security 1.1 (sections 9.4.1.2 and 9.4.1.3), and what stands for them on Zenoh,
/// before they are signed.
namespace rds::secure {

/// What holds for everybody in the domains 0 to 230: pictures are encrypted as they are, of all other topics
/// every submessage is. README.md gives the reasons.
std::string governance(const std::vector<std::string>& camera_topics);

/// What the holder of the certificate with this subject may do; anything else is denied.
std::string permissions(const Role& role, const std::string& subject, const Validity& validity);

/// What each role may do on Zenoh, in JSON: {"tracker": {"publishes": [topic, ...], "subscribes": [...]},
/// ...}, and for those that pass all on {"router": {"relays": true}}.
std::string access_list(const std::vector<Role>& roles);

}  // namespace rds::secure
