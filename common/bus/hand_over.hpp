// SPDX-License-Identifier: Apache-2.0
#pragma once

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

/// Both vendors count who still uses a piece of memory with an atomic, and use it again after the last. The
/// thread sanitizer does not see that count, as their libraries are not instrumented, so our code tells it.
/// No code at all in other builds.
namespace rds::bus::detail {

/// This thread has read the memory and will not again.
inline void tell_read([[maybe_unused]] const void* memory) {
#ifdef __SANITIZE_THREAD__
  __tsan_release(const_cast<void*>(memory));
#endif
}

/// Everybody has read the memory: it may be overwritten or freed.
inline void tell_read_by_all([[maybe_unused]] const void* memory) {
#ifdef __SANITIZE_THREAD__
  __tsan_acquire(const_cast<void*>(memory));
#endif
}

}  // namespace rds::bus::detail
