// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rds::service {

/// Gives memory back to the kernel that this process has freed and will hardly need again.
///
/// The C library keeps what is freed, so that the next picture finds its memory at once; after a burst of
/// large messages that may be hundreds of MB, in as many pieces as there are threads.
class FreedMemory {
 public:
  /// Call once a second: looks now and then, and acts when much has been free twice in a row.
  void look();

 private:
  int calls_ = 0;
  bool was_much_ = false;
};

}  // namespace rds::service
