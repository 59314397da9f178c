// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace rds::service {

/// A number that nobody else will have drawn: of a map epoch, of a map.
std::uint64_t random_id();

}  // namespace rds::service
