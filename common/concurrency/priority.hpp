// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <future>
#include <utility>

namespace rds::concurrency {

/// Lets others have the processor first: the calling thread, and those it starts, give way to threads with
/// lower values. Needs no privileges.
///
/// @param nice  0 (as others) to 19 (last); a value below the present one changes nothing.
/// @return false where the system does not allow it; the thread then goes on as before.
bool give_way(int nice);

/// give_way() of every thread that the process has and will have.
bool give_way_as_process(int nice);

/// Calls a function in a thread that gives way, and waits for it: the threads that it starts give way, too.
/// @return what it returns. @throws what it throws.
template <class Function>
auto giving_way(int nice, Function&& function) {
  return std::async(std::launch::async,
                    [&] {
                      give_way(nice);
                      return std::forward<Function>(function)();
                    })
      .get();
}

}  // namespace rds::concurrency
