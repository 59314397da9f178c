// SPDX-License-Identifier: Apache-2.0
#include "common/service/random_id.hpp"

#include <random>

namespace rds::service {

std::uint64_t random_id() {
  std::random_device device;
  return (static_cast<std::uint64_t>(device()) << 32) | device();
}

}  // namespace rds::service
