// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/bus/domain_lock.hpp"

namespace rds::test {

/// The domain of this process; no other test and no `rds run` on this machine has it.
inline int test_domain() {
  static const bus::DomainLock lock;
  return lock.domain();
}

}  // namespace rds::test
