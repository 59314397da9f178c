// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rds::service {

/// One pool of freed memory for all threads, instead of one for each: only of the first pool can all be given
/// back by FreedMemory, of the others the C library keeps up to 64 MB. For processes that may wait for each
/// other's allocations. Call before there are threads.
void share_freed_memory();

/// Gives memory back to the kernel that this process has freed and will hardly need again.
///
/// The C library keeps what is freed, so that the next picture finds its memory at once; after a burst of
/// large messages that may be hundreds of MB.
class FreedMemory {
 public:
  /// Call once a second: looks now and then, and acts when much has been free twice in a row.
  void look();

 private:
  int calls_ = 0;
  bool was_much_ = false;
};

}  // namespace rds::service
