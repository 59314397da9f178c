// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rds::bus::detail {

/// Cyclone DDS 0.10 does not survive every type description that others send: an object it cannot read leaves
/// a null pointer behind, and nested descriptions are read recursively without a limit. Our types need none,
/// so this program reads and offers none: the definitions in cyclonedds_discovery.cpp take the place of the
/// library's own two functions between discovery messages and their bytes.
///
/// @return false if this build of the library has announced a participant past those definitions.
bool cyclonedds_discovery_is_filtered();

}  // namespace rds::bus::detail
