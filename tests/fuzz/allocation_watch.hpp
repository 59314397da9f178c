// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace rds::fuzz {

/// How much memory is allocated at once since this object was made; programs that link it count every
/// operator new. One at a time, of one thread.
class AllocationWatch {
 public:
  AllocationWatch();
  [[nodiscard]] std::size_t peak_bytes() const;
};

}  // namespace rds::fuzz
