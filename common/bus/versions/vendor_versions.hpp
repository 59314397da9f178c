// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rds::bus {

/// Of the libraries that this program reaches the bus by, a line each. Zenoh's, which is loaded when it is
/// asked for, also says whether it is there.
std::string vendor_versions();

}  // namespace rds::bus
