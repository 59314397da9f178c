// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rds::concurrency {

/// Lets others have the processor first: the calling thread, and those it starts, give way to threads with
/// lower values. Needs no privileges.
///
/// @param nice  0 (as others) to 19 (last); a value below the present one changes nothing.
/// @return false where the system does not allow it; the thread then goes on as before.
bool give_way(int nice);

/// give_way() of every thread that the process has and will have.
bool give_way_as_process(int nice);

}  // namespace rds::concurrency
